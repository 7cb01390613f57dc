#ifndef BCCSKEL_SERVER_METRICS_METRICS_PAGE_H_
#define BCCSKEL_SERVER_METRICS_METRICS_PAGE_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace prometheus {
class Collectable;
class Exposer;
}  // namespace prometheus

namespace bccskel::server {

// The metrics as a page for Prometheus: HTTP, /metrics, without encryption.
class MetricsPage {
 public:
  using Collectables = std::vector<std::shared_ptr<prometheus::Collectable>>;

  // Serves `collectables` at `address`, HOST:PORT with port 0 for any free one.
  // Errors: INVALID_ARGUMENT for an address that cannot be listened on.
  static absl::StatusOr<std::unique_ptr<MetricsPage>> Start(const std::string& address,
                                                            Collectables collectables);
  ~MetricsPage();

  const std::string& address() const { return address_; }

 private:
  MetricsPage() = default;

  Collectables collectables_;  // prometheus-cpp does not own them
  std::unique_ptr<prometheus::Exposer> exposer_;
  std::string address_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_METRICS_METRICS_PAGE_H_
