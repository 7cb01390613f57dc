#ifndef BCCSKEL_SERVER_DECODING_CHILD_SANDBOX_H_
#define BCCSKEL_SERVER_DECODING_CHILD_SANDBOX_H_

namespace bccskel::server {

// Takes from this process for good what decoding does not need: new privileges, files, core dumps,
// executable memory and every system call but a dozen. It ends with its parent. Where the kernel
// has no seccomp, limits and privileges are all that is taken.
// Needs: one thread, no untrusted byte read yet.
void EnterChildSandbox();

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_CHILD_SANDBOX_H_
