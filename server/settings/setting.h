#ifndef BCCSKEL_SERVER_SETTINGS_SETTING_H_
#define BCCSKEL_SERVER_SETTINGS_SETTING_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel::server {

// One setting: --max-jobs N, BCCSKEL_MAX_JOBS=N, or max-jobs = N in a file.
struct Setting {
  std::string name;
  std::string value;  // its placeholder in the help: N, SIZE, ...
  std::string description;
  // Sets the values that one source gives. Errors: INVALID_ARGUMENT; nothing is set then.
  std::function<absl::Status(const std::vector<std::string>&)> set;
  // The value as in a file: 3 or "text" or ["a", "b"].
  std::function<std::string()> show;
  enum class Values { kOne, kList } values = Values::kOne;
};

// Each sets `target`, which must outlive the setting.
Setting NumberSetting(std::string name, int& target, int low, int high, std::string description);
Setting CountSetting(std::string name, uint64_t& target, std::string description);
Setting SizeSetting(std::string name, uint64_t& target, std::string description);
Setting MillisecondsSetting(std::string name, std::chrono::milliseconds& target,
                            std::string description);
Setting HoursSetting(std::string name, std::chrono::seconds& target, std::string description);
Setting ChoiceSetting(std::string name, std::string& target, std::vector<std::string> choices,
                      std::string description);
Setting TextSetting(std::string name, std::string value, std::string& target,
                    std::string description);
Setting PathSetting(std::string name, std::string& target, std::string description);
Setting AddressSetting(std::string name, std::string& target, std::string description);
Setting AddressesSetting(std::string name, std::vector<std::string>& target,
                         std::string description);

// Parse the values of settings. Errors: INVALID_ARGUMENT, with the value and the limit.
absl::StatusOr<int> ParseNumber(const std::string& text, int low, int high);
// A number of bytes, optionally with a unit in powers of 1024 (KB, MB, GB, TB, also KiB and so on).
absl::StatusOr<uint64_t> ParseSize(const std::string& text, uint64_t low);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SETTINGS_SETTING_H_
