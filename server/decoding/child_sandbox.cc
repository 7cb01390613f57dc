#include "server/decoding/child_sandbox.h"

#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <csignal>

namespace bccskel::server {
namespace {

// Sanitizers need system calls and address space of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

void Limit(__rlimit_resource resource, rlim_t most) {
  const rlimit limit = {most, most};
  setrlimit(resource, &limit);
}

// Memory, the channel, the end. Nothing opens, connects, forks, signals or changes a limit.
constexpr int kSystemCalls[] = {
    SCMP_SYS(read),   SCMP_SYS(write),      SCMP_SYS(recvfrom),     SCMP_SYS(sendto),
    SCMP_SYS(poll),   SCMP_SYS(recvmsg),    SCMP_SYS(close),        SCMP_SYS(munmap),
    SCMP_SYS(mremap), SCMP_SYS(madvise),    SCMP_SYS(brk),          SCMP_SYS(futex),
    SCMP_SYS(exit),   SCMP_SYS(exit_group), SCMP_SYS(rt_sigreturn), SCMP_SYS(restart_syscall),
};

void LoadFilter() {
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_KILL_PROCESS);
  if (filter == nullptr) return;
  for (const int call : kSystemCalls) seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0);
  seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(mmap), 1,
                   SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0));
  seccomp_load(filter);
  seccomp_release(filter);
}

}  // namespace

void EnterChildSandbox() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  prctl(PR_SET_DUMPABLE, 0);
  constexpr rlim_t kDescriptors = 8;  // three to /dev/null, the channel, a volume
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_FSIZE, 0);
  Limit(RLIMIT_NOFILE, kDescriptors);
  if (!kSanitized) LoadFilter();
}

}  // namespace bccskel::server
