#include "client/cli/common_options.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "absl/strings/match.h"
#include "absl/strings/str_join.h"
#include "client/cli/bench_core.h"
#include "client/cli/option_values.h"
#include "client/cli/thinning_options.h"
#include "client/export/skeleton_file.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/file_bytes.h"
#include "core/import/shapes/shapes.h"
#include "core/pipeline/option_words.h"

namespace bccskel::cli {
namespace {

constexpr char kTokenVariable[] = "BCCSKEL_TOKEN_FILE";

// The text of the file; empty if the path is.
absl::StatusOr<std::string> ReadText(const std::string& path) {
  constexpr uint64_t kMostBytes = 1 << 20;
  if (path.empty()) return std::string();
  BCCSKEL_ASSIGN_OR_RETURN(std::string text, ReadFileBytes(path, kMostBytes));
  // An empty file of authorities would turn TLS off.
  if (text.empty()) return absl::InvalidArgumentError(path + ": is empty");
  return text;
}

std::string TokenPath(const ServerArguments& server) {
  const char* const variable = std::getenv(kTokenVariable);
  return server.token_file.empty() && variable != nullptr ? variable : server.token_file;
}

// The first line of the file. Messages never contain it.
absl::StatusOr<std::string> ReadToken(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string text, ReadText(path));
  absl::StatusOr<std::string> token = client::TokenToSend(text.substr(0, text.find('\n')));
  if (path.empty() || (token.ok() && !token->empty())) return token;
  return absl::InvalidArgumentError(path + ": its first line is not a token");
}

}  // namespace

void AddJson(CLI::App& command, CommonArguments& common) {
  command.add_flag_callback(
      "--json", [&common] { common.summary = SummaryStyle::kJson; },
      "Print the summary as one JSON object");
}

void AddThreads(CLI::App& command, CommonArguments& common, const char* description) {
  command.add_option("--threads", common.threads, description)
      ->check(Within(0, 1024))
      ->option_text("N");
}

void AddCommonHere(CLI::App& command, CommonArguments& common) {
  AddThreads(command, common, kThreadsHere);
  AddProgress(command, common.progress);
  AddJson(command, common);
}

void AddProgress(CLI::App& command, ProgressStyle& progress) {
  AddChoice<ProgressStyle>(command, "--progress", progress,
                           "Show progress on standard error; auto (default): on a terminal",
                           {{"auto", ProgressStyle::kAuto},
                            {"always", ProgressStyle::kAlways},
                            {"never", ProgressStyle::kNever}});
}

CLI::Option* AddSeconds(CLI::App& command, const char* name, std::chrono::milliseconds& time,
                        const char* description) {
  return command
      .add_option_function<double>(
          name,
          [&time](double seconds) {
            time = std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000));
          },
          description)
      ->check(Within(0.001, 1e7))
      ->option_text("SECONDS");
}

void AddServer(CLI::App& command, ServerArguments& server) {
  command
      .add_option("--tls-ca", server.tls_ca,
                  "Use TLS and trust these certificate authorities, PEM (those of this machine: "
                  "/etc/ssl/certs/ca-certificates.crt)")
      ->option_text("FILE");
  command.add_option("--tls-cert", server.tls_certificate, "Certificate to show the server, PEM")
      ->option_text("FILE");
  command.add_option("--tls-key", server.tls_key, "Private key of --tls-cert, PEM")
      ->option_text("FILE");
  command
      .add_option("--token-file", server.token_file,
                  "File with the access token (default: the file that BCCSKEL_TOKEN_FILE names)")
      ->option_text("FILE");
  command.add_flag_callback(
      "--plaintext-token",
      [&server] { server.plaintext_token = client::Endpoint::PlaintextToken::kAllow; },
      "Allow sending the token over a network without TLS");
  command
      .add_option("--server", server.address,
                  "Address of the server (default " + server.address + ")")
      ->option_text("HOST:PORT|unix:PATH");
}

void AddPlace(CLI::App& command, ServerArguments& server, Place& place) {
  CLI::Option_group& group = *command.add_option_group("Server", "Compute on a server instead");
  AddServer(group, server);
  place = Place::kLocal;
  const std::string description =
      "Compute on this machine, without a server (default, unless a server is named)";
  const CLI::Option* local = command.add_flag("--local", description);
  group.parse_complete_callback([&group, &place, local] {
    for (const CLI::Option* option : group.get_options()) {
      if (option->count() == 0) continue;
      place = Place::kServer;
      if (local->count() == 0) continue;
      throw CLI::ValidationError("--local and " + option->get_name() + " exclude each other");
    }
  });
}

void AddComputing(CLI::App& command, ComputeArguments& arguments) {
  AddSkeletonOptions(command, arguments.skeletonize, arguments.root);
  AddThreads(command, arguments.common, kThreadsBoth);
  AddProgress(command, arguments.common.progress);
  AddSeconds(command, "--timeout", arguments.timeout,
             "Give up after this many seconds (default 3600)");
  AddJson(command, arguments.common);
}

absl::StatusOr<client::Endpoint> EndpointOf(const ServerArguments& server) {
  client::Endpoint endpoint;
  endpoint.address = server.address;
  endpoint.plaintext_token = server.plaintext_token;
  BCCSKEL_ASSIGN_OR_RETURN(endpoint.tls.ca, ReadText(server.tls_ca));
  BCCSKEL_ASSIGN_OR_RETURN(endpoint.tls.certificate, ReadText(server.tls_certificate));
  BCCSKEL_ASSIGN_OR_RETURN(endpoint.tls.key, ReadText(server.tls_key));
  BCCSKEL_ASSIGN_OR_RETURN(endpoint.token, ReadToken(TokenPath(server)));
  return endpoint;
}

void AddInput(CLI::App& command, const char* name, std::string& path, const char* description) {
  command.add_option(name, path, description)->required()->option_text(" ");
}

void AddOutput(CLI::App& command, std::string& path, const char* what,
               const std::vector<std::string>& endings) {
  const std::string choice = absl::StrJoin(endings, " or ");
  command.add_option("-o,--output", path, std::string(what) + " to write: " + choice)
      ->required()
      ->check([endings, choice](const std::string& given) {
        const auto fits = [&](const std::string& ending) {
          return absl::EndsWithIgnoreCase(given, ending);
        };
        return std::ranges::any_of(endings, fits) ? "" : given + ": does not end in " + choice;
      })
      ->option_text("FILE (required)");
}

CLI::Option* AddOutputs(CLI::App& command, std::vector<std::string>& outputs,
                        const std::string& what) {
  return command
      .add_option(
          "-o,--output", outputs,
          "Output file, " +
              (what.empty() ? "format by ending: " + exporting::SkeletonFormatEndings() : what) +
              "; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->option_text("FILE (required)");
}

void AddResult(CLI::App& command, std::string& path) {
  AddInput(command, "RESULT", path, "JSON file of skeletonize or submit");
}

void AddResultAndObject(CLI::App& command, ResultArguments& arguments, ObjectNeed need) {
  AddResult(command, arguments.result);
  CLI::Option* object = command.add_option("--object", arguments.object,
                                           "Mesh, volume or image that the result was made from");
  const bool required = need == ObjectNeed::kRequired;
  object->required(required)->option_text(required ? "FILE (required)" : "FILE");
  AddGrid(command, arguments.grid);
  command.get_option("--points")
      ->description("Number of lattice points inside the solid (default: as for the result)");
  AddImage(command, arguments.image);
  AddCommonHere(command, arguments.common);
}

CLI::Option* AddBenchShape(CLI::App& command, std::string& shape, const char* description) {
  return AddChoice<std::string>(command, "--shape", shape, description, Themselves(kBenchObjects));
}

void AddBenchMethod(CLI::App& command, ThinningMethod& method,
                    std::optional<DistanceKind>& distance, const char* description) {
  AddChoice<ThinningMethod>(command, "--method", method, description, Choices(kMethodWords));
  AddChoice<DistanceKind>(
      command, "--distance", [&distance](DistanceKind chosen) { distance = chosen; },
      "How distances are measured (default: euclidean with symmetric, otherwise chamfer)",
      Choices(kDistanceWords));
}

}  // namespace bccskel::cli
