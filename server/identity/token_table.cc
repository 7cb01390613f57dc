#include "server/identity/token_table.h"

#include <openssl/crypto.h>
#include <sys/random.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "server/settings/setting.h"

namespace bccskel::server {
namespace {

constexpr size_t kMaxFileBytes = size_t{1} << 20;
constexpr int kMaxWeight = 1000;
constexpr int kMaxCount = 1'000'000;

absl::StatusOr<Sha256Digest> DigestFromHex(const std::string& hex) {
  Sha256Digest digest;
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (hex.size() == 2 * digest.bytes.size() && std::ranges::all_of(hex, is_digit)) {
    const std::string bytes = absl::HexStringToBytes(hex);
    std::ranges::copy(bytes, digest.bytes.begin());
    return digest;
  }
  return absl::InvalidArgumentError(
      "the second word must be the SHA-256 of a token, 64 hexadecimal digits in lower case");
}

template <typename Number>
absl::Status SetOnce(absl::StatusOr<Number> value, Number& target) {
  if (!value.ok()) return value.status();
  const Number unset = target;
  if (unset != Number{} && unset != *value) {
    return absl::InvalidArgumentError(
        absl::StrCat(*value, ", another line of the same tenant says ", unset));
  }
  target = *value;
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::string> NewToken() {
  Sha256Digest secret;  // for its size and its digits
  const ssize_t got = getrandom(secret.bytes.data(), secret.bytes.size(), 0);
  if (got != static_cast<ssize_t>(secret.bytes.size())) {
    return absl::UnavailableError("the system provides no random bytes");
  }
  return "bccskel_" + secret.Hex();
}

bool SameDigest(const Sha256Digest& a, const Sha256Digest& b) {
  return CRYPTO_memcmp(a.bytes.data(), b.bytes.data(), a.bytes.size()) == 0;
}

bool IsTenantName(std::string_view name) {
  constexpr size_t kLongest = 64;
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  return !name.empty() && name.size() <= kLongest && plain(name.front()) &&
         std::ranges::all_of(name, [&](char c) { return plain(c) || c == '-' || c == '_'; });
}

absl::Status TokenTable::AddTerm(const std::string& word, Entry& entry) {
  if (word == "admin") {
    entry.caller.role = Role::kAdmin;
    return absl::OkStatus();
  }
  const std::pair<std::string, std::string> term = absl::StrSplit(word, absl::MaxSplits('=', 1));
  const auto& [name, value] = term;
  TenantLimits& limits = tenants_[entry.caller.tenant];
  absl::Status status = absl::InvalidArgumentError(
      "must be admin, weight=N, max-jobs=N, max-running=N or max-memory-bytes=SIZE");
  if (name == "weight") status = SetOnce(ParseNumber(value, 1, kMaxWeight), limits.weight);
  if (name == "max-jobs") status = SetOnce(ParseNumber(value, 1, kMaxCount), limits.max_jobs);
  if (name == "max-running") status = SetOnce(ParseNumber(value, 1, kMaxCount), limits.max_running);
  if (name == "max-memory-bytes") status = SetOnce(ParseSize(value, 1), limits.max_bytes);
  if (status.ok()) return status;
  return absl::InvalidArgumentError(absl::StrCat(word, ": ", std::string(status.message())));
}

std::vector<std::string> TokenTable::AddLine(const std::vector<std::string>& words) {
  if (!IsTenantName(words[0])) {
    return {
        "the first word must be a tenant's name: 1 to 64 of a-z, 0-9, - and _, a letter or digit "
        "first"};
  }
  if (words.size() < 2) return {"the SHA-256 of the token is missing"};
  std::vector<std::string> errors;
  const auto note = [&errors](const absl::Status& status) {
    if (!status.ok()) errors.emplace_back(status.message());
  };
  Entry entry = {.digest = {}, .caller = {.tenant = words[0]}};
  const absl::StatusOr<Sha256Digest> digest = DigestFromHex(words[1]);
  note(digest.status());
  if (digest.ok()) entry.digest = *digest;
  const bool again = digest.ok() && std::ranges::any_of(entries_, [&](const Entry& other) {
                       return SameDigest(other.digest, *digest);
                     });
  if (again) errors.emplace_back("this token is also in another line");
  tenants_.try_emplace(words[0], TenantLimits{.weight = 0});
  for (size_t n = 2; n < words.size(); ++n) note(AddTerm(words[n], entry));
  entries_.push_back(std::move(entry));
  return errors;
}

absl::StatusOr<TokenTable> TokenTable::Parse(std::string_view text) {
  constexpr size_t kMostErrors = 20;
  TokenTable table;
  std::vector<std::string> errors;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line.resize(std::min(line.find('#'), line.size()));
    const std::vector<std::string> words =
        absl::StrSplit(line, absl::ByAnyChar(" \t\r"), absl::SkipEmpty());
    if (words.empty()) continue;
    for (const std::string& error : table.AddLine(words)) {
      errors.push_back(absl::StrCat("line ", number, ": ", error));
    }
  }
  if (errors.size() > kMostErrors) {
    const size_t more = errors.size() - kMostErrors;
    errors.resize(kMostErrors);
    errors.push_back(absl::StrCat("and ", more, " more errors"));
  }
  if (!errors.empty()) return absl::InvalidArgumentError(absl::StrJoin(errors, "; "));
  for (auto& [name, limits] : table.tenants_) limits.weight = std::max(1, limits.weight);
  return table;
}

absl::StatusOr<TokenTable> TokenTable::ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMaxFileBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file.is_open() || file.bad()) {
    return absl::NotFoundError(absl::StrCat(path, ": cannot be read: ", std::strerror(errno)));
  }
  text.resize(static_cast<size_t>(file.gcount()));
  if (text.size() > kMaxFileBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ": is larger than ", kMaxFileBytes, " bytes"));
  }
  absl::StatusOr<TokenTable> table = Parse(text);
  if (table.ok()) return table;
  return absl::InvalidArgumentError(
      absl::StrCat(path, ": ", std::string(table.status().message())));
}

std::optional<Caller> TokenTable::Find(std::string_view token) const {
  const Sha256Digest digest = Sha256Of(token);
  const Entry* found = nullptr;
  for (const Entry& entry : entries_) {
    if (SameDigest(entry.digest, digest)) found = &entry;
  }
  return found == nullptr ? std::nullopt : std::optional(found->caller);
}

std::string TokenLine(const std::string& tenant, std::string_view token) {
  return tenant + " " + Sha256Of(token).Hex();
}

}  // namespace bccskel::server
