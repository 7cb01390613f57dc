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

// A scraper that does not read its answer holds up no other for longer than this.
constexpr char kRequestTimeoutMs[] = "5000";

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
        std::vector<std::string>{"listening_ports", ForCivetweb(address), "num_threads", "2",
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
