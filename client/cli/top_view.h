#ifndef BCCSKEL_CLIENT_CLI_TOP_VIEW_H_
#define BCCSKEL_CLIENT_CLI_TOP_VIEW_H_

#include <chrono>
#include <optional>
#include <string>

#include "client/operations.h"

namespace bccskel::cli {

// What a server did per second between two looks.
struct TopRates {
  double calls = 0;
  double jobs = 0;
  double points = 0;
  double processors = 0;  // processor seconds per second
};

TopRates RatesBetween(const client::ServerStatus& before, const client::ServerStatus& after);

// A screen of text, and a line of JSON. Without rates there was only one look.
std::string TopText(const std::string& address, const client::ServerStatus& status,
                    const std::optional<TopRates>& rates);
std::string TopJson(const client::ServerStatus& status, const std::optional<TopRates>& rates);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_TOP_VIEW_H_
