#include "server/jobs/names.h"

#include <algorithm>
#include <iterator>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/digest/random_id.h"
#include "core/digest/sha256.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

constexpr char kUploads[] = "uploads/";
constexpr size_t kMostUploadNameBytes = 64;
constexpr size_t kIdDigits = 32;

bool IsNameCharacter(char c) {
  return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_';
}

}  // namespace

std::string RandomName(const std::string& kind) { return absl::StrCat(kind, "/", RandomId()); }

std::string VolumeName(const std::string& declaration, const std::string& blob_digest) {
  return absl::StrCat("volumes/", KeyOf({declaration, blob_digest}).substr(0, kIdDigits));
}

absl::Status CheckUploadName(const std::string& name) {
  const size_t front = std::size(kUploads) - 1;
  if (name.compare(0, front, kUploads) == 0 && name.size() > front &&
      name.size() <= front + kMostUploadNameBytes &&
      std::all_of(name.begin() + static_cast<ptrdiff_t>(front), name.end(), IsNameCharacter)) {
    return absl::OkStatus();
  }
  return InvalidField(
      "config.upload",
      absl::StrCat("\"", absl::CHexEscape(name.substr(0, front + kMostUploadNameBytes)), "\" (",
                   name.size(), " bytes), must be \"uploads/\" and 1 to ", kMostUploadNameBytes,
                   " letters, digits, '-' and '_'"));
}

std::string KeyOf(std::initializer_list<std::string> parts) {
  Sha256 sha256;
  for (const std::string& part : parts) {
    sha256.AddUint64(part.size());
    sha256.Add(part);
  }
  return sha256.Finish().Hex();
}

}  // namespace bccskel::server
