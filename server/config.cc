#include "server/config.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/exec/machine_memory.h"
#include "core/version/version.h"
#include "proto/address/address.h"
#include "server/identity/token_table.h"
#include "server/store/job_store.h"

namespace bccskel::server {
namespace {

constexpr int kUsageError = 2;
constexpr char kName[] = "bccskel-server";

std::vector<Setting> ListenerSettings(ServerConfig& config) {
  return {
      AddressesSetting("listen", config.listen,
                       "HOST:PORT (port 0: any free one) or unix:PATH; may be given several times"),
      AddressSetting("admin-listen", config.admin_listen,
                     "Address for reflection, admin calls and health (default: those of --listen "
                     "on this machine)"),
      AddressSetting("metrics-listen", config.metrics_listen,
                     "HOST:PORT for Prometheus, HTTP at /metrics"),
      PathSetting("tls-cert", config.tls.certificate,
                  "Certificate chain, PEM; reloaded when it changes"),
      PathSetting("tls-key", config.tls.key,
                  "Key of the certificate, PEM; reloaded when it changes"),
      PathSetting(
          "tls-client-ca", config.tls.client_ca,
          "Require client certificates signed by these authorities, PEM; reloaded when it changes"),
      PathSetting("tokens", config.tokens,
                  "Require a token from this file; reloaded when it changes"),
      ChoiceSetting("plaintext-tokens", config.plaintext_tokens, {"refuse", "allow"},
                    "Whether tokens may cross a network without TLS"),
  };
}

std::vector<Setting> LimitSettings(ServerConfig& config) {
  JobPool::Limits& limits = config.limits;
  constexpr int kMaxThreads = 4096, kMaxQueue = 1'000'000;
  return {
      NumberSetting("threads", limits.threads, 1, kMaxThreads,
                    "Compute threads of all jobs together"),
      NumberSetting("max-jobs", limits.max_jobs, 1, kMaxThreads,
                    "Maximum number of concurrent jobs"),
      NumberSetting("max-queue", limits.max_queue, 0, kMaxQueue,
                    "Maximum number of jobs that upload or wait"),
      SizeSetting("max-memory-bytes", limits.max_bytes,
                  "Limit of the working memory of all jobs together, such as 8GB"),
      SizeSetting("max-volume-bytes", limits.max_volume_bytes,
                  "Limit of the size of one encoded volume, such as 256MB"),
      CountSetting("max-bricks", limits.volume.max_bricks,
                   "Limit of the occupied bricks (512 points each) of one volume"),
      MillisecondsSetting("sender-timeout-ms", config.caller_timeouts.sender,
                          "Time limit for a caller to send the next 1 MiB of its volume; 0: none"),
      MillisecondsSetting("reader-timeout-ms", config.caller_timeouts.reader,
                          "Time limit for a caller to read the next response; 0: none"),
  };
}

std::vector<Setting> DurableSettings(DurableOptions& durable) {
  return {
      PathSetting("data-dir", durable.data_directory,
                  "Folder for uploads, jobs and results, which then survive restarts; without it "
                  "they are kept in memory only"),
      TextSetting("job-store", "URL", durable.job_store,
                  "PostgreSQL database for several servers that share the data folder, as "
                  "postgresql://USER@HOST/DB; without it one server uses SQLite in the folder"),
      SizeSetting("max-disk-bytes", durable.max_disk_bytes,
                  "Disk quota of the data folder, such as 100GB; 0: no limit"),
      SizeSetting("max-tenant-disk-bytes", durable.max_tenant_disk_bytes,
                  "Disk quota of each tenant; 0: no limit"),
      HoursSetting("keep-uploads", durable.keep_uploads,
                   "Delete unfinished uploads this long after their last byte"),
      HoursSetting("keep-volumes", durable.keep_volumes,
                   "Delete volumes this long after their last use"),
      HoursSetting("keep-results", durable.keep_results,
                   "Delete jobs and results this long after their end"),
      ChoiceSetting("unknown-data", durable.unknown_data, {"refuse", "adopt"},
                    "Files in the data folder that jobs.db does not list: refuse to start, or "
                    "start without them"),
  };
}

std::vector<Setting> OperationSettings(ServerConfig& config) {
  return {
      MillisecondsSetting(
          "lame-duck-ms", config.lame_duck,
          "On SIGTERM: how long to fail health checks before draining, for a load balancer"),
      MillisecondsSetting("drain-ms", config.drain,
                          "On SIGTERM: how long running calls may continue"),
      ChoiceSetting("log-level", config.log_level,
                    {"trace", "debug", "info", "warning", "error", "off"},
                    "Level of the log on standard error, in JSON lines"),
  };
}

std::vector<Setting> SettingsOf(ServerConfig& config) {
  std::vector<Setting> all;
  for (auto&& part : {ListenerSettings(config), LimitSettings(config),
                      DurableSettings(config.durable), OperationSettings(config)}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

const std::vector<Action>& Actions() {
  static const std::vector<Action> actions = {
      {"config", "FILE",
       "Settings file of lines like max-jobs = 4 (default: the file that BCCSKEL_CONFIG names)"},
      {"check-config", "", "Print the settings in force and the errors in them, and exit"},
      {"new-token", "TENANT", "Print a new token and its line for the --tokens file, and exit"},
  };
  return actions;
}

// Determines every setting and records its origin and errors.
struct SettingsResolver {
  std::vector<std::string> problems;
  std::map<std::string, std::string> origins;  // by setting

  void Take(const Setting& setting, const std::vector<std::string>& values,
            const std::string& spelled, const std::string& origin) {
    const absl::Status status = setting.set(values);
    origins[setting.name] = origin;
    if (status.ok()) return;
    problems.push_back(absl::StrCat(spelled, ": ", std::string(status.message())));
  }
};

// The first source that gives a setting wins.
void Resolve(const std::vector<Setting>& settings, const GivenValues& flags,
             const GivenValues& variables, const GivenValues& file, SettingsResolver& resolver) {
  for (const Setting& setting : settings) {
    const std::string& name = setting.name;
    if (const auto flag = flags.find(name); flag != flags.end()) {
      // Such as --tokens "$UNSET", which must not mean: no tokens are needed.
      if (std::ranges::count(flag->second, std::string()) > 0) {
        resolver.problems.push_back(
            absl::StrCat("--", name, ": is empty: give a ", setting.value, " or leave it out"));
        continue;
      }
      resolver.Take(setting, flag->second, "--" + name, "command line");
    } else if (const auto found = variables.find(name); found != variables.end()) {
      resolver.Take(setting, found->second, VariableOf(name), "environment");
    } else if (const auto line = file.find(name); line != file.end()) {
      resolver.Take(setting, line->second, name, "file");
    }
  }
}

void RefuseUnknown(const std::vector<Setting>& settings, const GivenValues& file,
                   SettingsResolver& resolver) {
  for (const auto& [name, values] : file) {
    if (std::ranges::find(settings, name, &Setting::name) != settings.end()) continue;
    resolver.problems.push_back(
        name + (name.starts_with('[') ? ": the file must hold no sections; write its settings above"
                                      : ": there is no such setting"));
  }
}

bool IsOpen(const std::string& address) { return !IsOfThisMachine(address); }

// Checks that involve several settings, or the files that they name.
absl::Status CheckTokens(const ServerConfig& config) {
  if (config.tokens.empty()) return absl::OkStatus();
  const absl::Status table = TokenTable::ReadFile(config.tokens).status();
  absl::Status file(table.code(), absl::StrCat("--tokens: ", table.message()));
  if (!file.ok() || config.tls.enabled() || config.plaintext_tokens == "allow") return file;
  std::vector<std::string> addresses = config.listen;
  if (!config.admin_listen.empty()) addresses.push_back(config.admin_listen);
  const auto open = std::ranges::find_if(addresses, IsOpen);
  if (open == addresses.end()) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      "tokens would cross the network of ", *open,
      " in the clear: give --tls-cert and --tls-key, or --plaintext-tokens allow where something "
      "else protects that network"));
}

absl::Status CheckJobStore(const ServerConfig& config) {
  const DurableOptions& durable = config.durable;
  if (durable.job_store.empty()) return absl::OkStatus();
  if (durable.data_directory.empty()) {
    return absl::InvalidArgumentError(
        "--job-store needs --data-dir, the folder that servers share");
  }
  const absl::Status name = CheckPostgresName(durable.job_store);
  return name.ok() ? name
                   : absl::InvalidArgumentError(absl::StrCat("--job-store: ", name.message()));
}

absl::Status CheckMetricsAddress(const ServerConfig& config) {
  if (!absl::StartsWith(config.metrics_listen, "unix:")) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("--metrics-listen: ", config.metrics_listen, ": must be HOST:PORT"));
}

void CheckTogether(const ServerConfig& config, SettingsResolver& resolver) {
  for (const absl::Status& status : {CheckTlsFiles(config.tls), CheckTokens(config),
                                     CheckMetricsAddress(config), CheckJobStore(config)}) {
    if (!status.ok()) resolver.problems.emplace_back(status.message());
  }
}

GivenValues FromFile(const CommandLine& line, const Variable& variable,
                     SettingsResolver& resolver) {
  const auto flag = line.actions.find("config");
  const char* const named = variable("BCCSKEL_CONFIG");
  std::string path = named == nullptr ? "" : named;
  if (flag != line.actions.end()) path = flag->second;
  if (path.empty()) return {};
  absl::StatusOr<GivenValues> file = ReadConfigFile(path);
  if (file.ok()) return *std::move(file);
  const char* const given_by = flag != line.actions.end() ? "--config" : "BCCSKEL_CONFIG";
  resolver.problems.push_back(absl::StrCat(given_by, ": ", file.status().message()));
  return {};
}

std::string ProblemText(const std::vector<std::string>& problems) {
  std::string text;
  for (const std::string& problem : problems) absl::StrAppend(&text, kName, ": ", problem, "\n");
  return text;
}

std::string SettingsText(const std::vector<Setting>& settings, const SettingsResolver& resolver) {
  std::string text;
  for (const Setting& setting : settings) {
    const auto origin = resolver.origins.find(setting.name);
    absl::StrAppend(&text, setting.name, " = ", setting.show(), "  # ",
                    origin == resolver.origins.end() ? "default" : origin->second, "\n");
  }
  return text;
}

ExitRequest MakeToken(const std::string& tenant) {
  if (!IsTenantName(tenant)) {
    return {kUsageError, "",
            ProblemText({absl::StrCat("--new-token ", tenant,
                                      ": a tenant's name has 1 to 64 of a-z, 0-9, - and _, a "
                                      "letter or digit first")})};
  }
  const absl::StatusOr<std::string> token = NewToken();
  if (!token.ok()) return {1, "", ProblemText({std::string(token.status().message())})};
  return {0, absl::StrCat(*token, "\n", TokenLine(tenant, *token), "\n"),
          "The first line is the token, for the caller's --token-file alone; the second goes into "
          "the server's --tokens file.\n"};
}

}  // namespace

ServerConfig DefaultServerConfig() {
  ServerConfig config;
  config.limits.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  config.limits.max_jobs = config.limits.threads;
  config.limits.max_queue = 64;
  config.limits.max_bytes = exec::AvailableMemoryBytes() / 4 * 3;
  config.limits.max_volume_bytes = uint64_t{1} << 30;
  return config;
}

std::variant<ServerConfig, ExitRequest> ParseServerConfig(int argc, const char* const* argv,
                                                          const Variable& variable) {
  ServerConfig config = DefaultServerConfig();
  const std::vector<Setting> settings = SettingsOf(config);
  const Program program = {
      kName, std::string(Version()),
      "Turns volumes on the body-centered cubic grid into curve skeletons, over gRPC."};
  const auto read = ReadCommandLine(program, settings, Actions(), argc, argv);
  if (const auto* exit = std::get_if<ExitRequest>(&read)) return *exit;
  const CommandLine& line = std::get<CommandLine>(read);
  if (const auto tenant = line.actions.find("new-token"); tenant != line.actions.end()) {
    return MakeToken(tenant->second);
  }
  SettingsResolver resolver;
  const GivenValues file = FromFile(line, variable, resolver);
  Resolve(settings, line.values, ReadEnvironment(settings, variable), file, resolver);
  RefuseUnknown(settings, file, resolver);
  if (!resolver.origins.contains("max-jobs")) config.limits.max_jobs = config.limits.threads;
  CheckTogether(config, resolver);
  const int code = resolver.problems.empty() ? 0 : kUsageError;
  if (line.actions.contains("check-config")) {
    return ExitRequest{code, SettingsText(settings, resolver), ProblemText(resolver.problems)};
  }
  if (code != 0) return ExitRequest{code, "", ProblemText(resolver.problems)};
  return config;
}

}  // namespace bccskel::server
