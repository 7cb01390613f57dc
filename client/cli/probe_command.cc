#include <utility>

#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/summaries.h"
#include "client/export/text.h"
#include "client/operations.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

absl::Status Probe(const ProbeArguments& arguments, const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const client::Endpoint endpoint, EndpointOf(arguments.server));
  BCCSKEL_ASSIGN_OR_RETURN(const auto operations, client::Operations::Create(endpoint));
  absl::Status health = operations->CheckHealth(arguments.service, arguments.timeout, stop);
  if (!absl::IsNotFound(health)) return health;
  return absl::NotFoundError("it has no service " + arguments.service +
                             "; without --service, probe asks for the whole server");
}

std::string Summary(const ProbeArguments& arguments) {
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add("{\"server\":", JsonString(arguments.server.address),
             ",\"service\":", JsonString(arguments.service), ",\"status\":\"SERVING\"}\n");
  } else {
    text.Add(arguments.server.address, ": serving\n");
  }
  return std::move(text).Take();
}

}  // namespace

void AddProbe(CLI::App& command, ProbeArguments& arguments) {
  AddServer(command, arguments.server);
  command
      .add_option("--service", arguments.service,
                  "One service, such as bccskel.v1.JobService, instead of the whole server")
      ->option_text("NAME");
  AddSeconds(command, "--timeout", arguments.timeout, "Give up after this time (default 5)");
  AddJson(command, arguments.common);
}

ExitCode Run(const ProbeArguments& arguments, const std::stop_token& stop) {
  const absl::Status status = Probe(arguments, stop);
  return status.ok() ? Print(Summary(arguments)) : FailOnServer(arguments.server, status);
}

}  // namespace bccskel::cli
