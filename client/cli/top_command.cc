#include <unistd.h>

#include <memory>
#include <optional>

#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/server_arguments.h"
#include "client/cli/top_view.h"
#include "client/operations.h"
#include "client/retry_policy.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

constexpr std::chrono::milliseconds kPatience = std::chrono::seconds(10);

absl::StatusOr<std::unique_ptr<client::Operations>> Open(const TopArguments& arguments) {
  BCCSKEL_ASSIGN_OR_RETURN(const client::Endpoint endpoint, EndpointOf(arguments.server));
  return client::Operations::Create(endpoint);
}

ExitCode Show(const TopArguments& arguments, const client::ServerStatus& status,
              const std::optional<TopRates>& rates) {
  if (arguments.common.summary == SummaryStyle::kJson) return Print(TopJson(status, rates));
  // On a terminal each look takes the place of the one before.
  const bool clear = arguments.repeat == TopRepeat::kForever && isatty(STDOUT_FILENO) == 1;
  const std::string screen = clear ? "\x1b[H\x1b[2J" : "";
  return Print(screen + TopText(arguments.server.address, status, rates));
}

}  // namespace

ExitCode Run(const TopArguments& arguments, const std::stop_token& stop) {
  const auto operations = Open(arguments);
  if (!operations.ok()) return FailOnServer(arguments.server, operations.status());
  std::optional<client::ServerStatus> before;
  while (true) {
    const absl::StatusOr<client::ServerStatus> status = (*operations)->GetStatus(kPatience);
    if (!status.ok()) return FailOnServer(arguments.server, status.status());
    std::optional<TopRates> rates;
    if (before.has_value()) rates = RatesBetween(*before, *status);
    const ExitCode shown = Show(arguments, *status, rates);
    if (shown != ExitCode::kOk || arguments.repeat == TopRepeat::kOnce) return shown;
    before = *status;
    client::PauseFor(arguments.interval, stop);
    if (stop.stop_requested()) return ExitCode::kInterrupted;
  }
}

}  // namespace bccskel::cli
