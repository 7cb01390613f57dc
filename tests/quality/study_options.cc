#include "tests/quality/study_options.h"

#include <algorithm>
#include <functional>
#include <map>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "core/pipeline/presets.h"

namespace bccskel::quality {
namespace {

using Setter = std::function<bool(const std::string&)>;

template <typename Value>
bool Choose(const std::map<std::string, Value>& choices, const std::string& name, Value& value) {
  const auto found = choices.find(name);
  if (found == choices.end()) return false;
  value = found->second;
  return true;
}

template <typename Value, typename Parse>
bool ParseList(const std::string& text, std::vector<Value>& values, Parse parse) {
  values.clear();
  for (const std::string& part : std::vector<std::string>(absl::StrSplit(text, ','))) {
    if (!parse(part, &values.emplace_back())) return false;
  }
  return true;
}

bool ParsePercent(const std::string& text, double* share) {
  const bool parsed = absl::SimpleAtod(text, share);
  *share /= 100;
  return parsed;
}

std::map<std::string, Setter> SettersOf(StudyOptions& options) {
  const auto text = [](std::string& value) {
    return [&value](const std::string& given) {
      value = given;
      return true;
    };
  };
  const auto texts = [](std::vector<std::string>& value) {
    return [&value](const std::string& given) {
      value = absl::StrSplit(given, ',');
      return true;
    };
  };
  PruningOptions& pruning = options.skeleton.pruning;
  return {
      {"points",
       [&](const std::string& given) {
         return ParseList(given, options.points, [](const std::string& part, uint64_t* points) {
           return absl::SimpleAtoi(part, points);
         });
       }},
      {"noise",
       [&](const std::string& given) { return ParseList(given, options.noise, ParsePercent); }},
      {"turns", [&](const std::string& given) { return absl::SimpleAtoi(given, &options.turns); }},
      {"as", texts(options.as)},
      {"only", texts(options.only)},
      {"data", text(options.data)},
      {"dump", text(options.dump)},
      {"half",
       [&](const std::string& given) {
         return Choose({{"tune", Half::kTune}, {"judge", Half::kJudge}, {"all", Half::kAll}}, given,
                       options.half);
       }},
      {"border",
       [&](const std::string& given) {
         return Choose(
             {{"auto", Border::kAuto}, {"ends", Border::kEnds}, {"continues", Border::kContinues}},
             given, options.skeleton.border);
       }},
      {"preset",
       [&](const std::string& given) { return ApplyPreset(given, options.skeleton).ok(); }},
      {"threshold",
       [&](const std::string& given) { return absl::SimpleAtod(given, &pruning.threshold); }},
      {"rule",
       [&](const std::string& given) {
         return Choose({{"significance", PruningRule::kSignificance},
                        {"length", PruningRule::kLength},
                        {"relative-length", PruningRule::kRelativeLength},
                        {"persistence", PruningRule::kPersistence},
                        {"none", PruningRule::kNone}},
                       given, pruning.rule);
       }},
      {"merge-junctions",
       [&](const std::string& given) {
         return absl::SimpleAtod(given, &options.skeleton.junction_reach);
       }},
      {"kind",
       [&](const std::string& given) {
         return Choose({{"curve", SkeletonKind::kCurve},
                        {"isthmus-curve", SkeletonKind::kIsthmusCurve},
                        {"surface", SkeletonKind::kSurface}},
                       given, options.skeleton.thinning.kind);
       }},
  };
}

}  // namespace

bool StudyOptions::Wants(const std::string& name) const {
  return only.empty() || std::ranges::any_of(only, [&](const std::string& part) {
           return name.find(part) != std::string::npos;
         });
}

absl::StatusOr<StudyOptions> ParseStudyOptions(std::span<const std::string> arguments) {
  StudyOptions options;
  const std::map<std::string, Setter> setters = SettersOf(options);
  for (size_t n = 0; n < arguments.size(); ++n) {
    if (arguments[n] == "--json") {
      options.json = true;
      continue;
    }
    const auto setter = setters.find(arguments[n].substr(std::min<size_t>(2, arguments[n].size())));
    if (setter == setters.end() || !arguments[n].starts_with("--")) {
      std::string known = "--json";
      for (const auto& [name, set] : setters) absl::StrAppend(&known, ", --", name);
      return absl::InvalidArgumentError(
          absl::StrCat("\"", arguments[n], "\" is not known; there are ", known));
    }
    if (n + 1 == arguments.size() || !setter->second(arguments[n + 1])) {
      return absl::InvalidArgumentError(absl::StrCat(
          arguments[n], " ", n + 1 == arguments.size() ? "" : arguments[n + 1], ": no such value"));
    }
    ++n;
  }
  return options;
}

}  // namespace bccskel::quality
