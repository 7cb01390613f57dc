#include "server/metrics/metrics_page.h"

#include <prometheus/collectable.h>
#include <prometheus/exposer.h>

#include <exception>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/settings/values.h"

namespace bccskel::server {
namespace {

// Who connects and asks for nothing, or does not read the answer, takes a thread for this time.
// With so many threads the next scraper waits for none of them, or not for long.
constexpr char kRequestTimeoutMs[] = "3000";
constexpr char kThreads[] = "16";

// civetweb takes numbers for hosts only.
std::string ForCivetweb(const std::string& address) {
  constexpr char kName[] = "localhost:";
  if (!absl::StartsWith(address, kName)) return address;
  return "127.0.0.1:" + address.substr(sizeof(kName) - 1);
}

}  // namespace

absl::StatusOr<std::unique_ptr<MetricsPage>> MetricsPage::Start(const std::string& address,
                                                                Collectables collectables) {
  std::unique_ptr<MetricsPage> page(new MetricsPage);
  page->collectables_ = std::move(collectables);
  try {
    page->exposer_ = std::make_unique<prometheus::Exposer>(
        std::vector<std::string>{"listening_ports", ForCivetweb(address), "num_threads", kThreads,
                                 "request_timeout_ms", kRequestTimeoutMs});
    for (const auto& collectable : page->collectables_) {
      page->exposer_->RegisterCollectable(collectable);
    }
    page->address_ = absl::StrCat(HostOf(address), ":", page->exposer_->GetListeningPorts().at(0));
  } catch (const std::exception&) {
    return absl::InvalidArgumentError(absl::StrCat("cannot listen on ", address, " for metrics"));
  }
  return page;
}

MetricsPage::~MetricsPage() = default;

}  // namespace bccskel::server
