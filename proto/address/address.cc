#include "proto/address/address.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace bccskel {
namespace {

constexpr char kDigits[] = "0123456789";

constexpr int kLastPort = 65535;

bool IsPort(const std::string& text, int least) {
  const bool digits = text.find_first_not_of(kDigits) == std::string::npos;
  if (!digits || text.empty() || text.size() > 5) return false;
  return std::stoi(text) >= least && std::stoi(text) <= kLastPort;
}

bool IsAddress(const std::string& address, int least_port) {
  if (address.starts_with(kUnixPrefix)) {
    return address != kUnixPrefix && address.find('\0') == std::string::npos;
  }
  const std::string host = HostOf(address);
  const bool unclear = std::ranges::any_of(
      host, [](unsigned char c) { return absl::ascii_isspace(c) || absl::ascii_iscntrl(c); });
  return !host.empty() && !unclear && host.size() < address.size() &&
         IsPort(address.substr(host.size() + 1), least_port) && !address.starts_with("http://") &&
         !address.starts_with("https://");
}

}  // namespace

absl::Status CheckAddress(const std::string& address, int least_port) {
  if (IsAddress(address, least_port)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("'", address,
                                                 "' is neither HOST:PORT, with a port of ",
                                                 least_port, " to ", kLastPort, ", nor unix:PATH"));
}

std::string SocketPathOf(const std::string& address) {
  if (!address.starts_with(kUnixPrefix)) return std::string();
  const std::string path = address.substr(sizeof(kUnixPrefix) - 1);
  return path.starts_with("//") ? path.substr(2) : path;
}

std::string HostOf(const std::string& address) { return address.substr(0, address.rfind(':')); }

bool IsOfThisMachine(const std::string& address) {
  if (address.starts_with(kUnixPrefix)) return true;
  const std::string host = HostOf(address);
  const bool number = host.find_first_not_of("0123456789.") == std::string::npos;
  return host == "localhost" || host == "[::1]" || (number && host.starts_with("127."));
}

}  // namespace bccskel
