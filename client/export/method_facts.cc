#include "client/export/method_facts.h"

#include <algorithm>

#include "client/export/picture/escape.h"
#include "client/export/text.h"
#include "core/certificate/describe_changes.h"
#include "core/pipeline/notes.h"
#include "core/pipeline/option_words.h"

namespace bccskel::exporting {
namespace {

void AddChanges(const std::vector<PreparingStep>& steps, const Certificate& certificate,
                MethodFacts& facts) {
  std::string prepared;
  for (const PreparingStep& step : steps) {
    prepared += (prepared.empty() ? "" : ", ") + WordsFor(step);
  }
  if (!prepared.empty()) facts.emplace_back("prepared", prepared);
  facts.emplace_back("check", VerdictInWords(certificate));
}

}  // namespace

MethodFacts MethodFactsOf(const SkeletonizeResult& result, const World& world) {
  MethodFacts facts = {{"method", result.method},
                       {"algorithm_version", result.algorithm_version},
                       {"world", std::string(OrUnknown(world.axes))},
                       {"unit", std::string(OrUnknown(world.unit))}};
  for (const OptionFact& fact : FactsOf(result.options)) facts.emplace_back(fact.name, fact.value);
  AddChanges(result.preparing, result.certificate, facts);
  return facts;
}

MethodFacts MethodFactsOf(const view::ResultFacts& result) {
  MethodFacts facts = {{"method", result.method},
                       {"algorithm_version", result.algorithm_version},
                       {"world", std::string(OrUnknown(result.world))},
                       {"unit", std::string(OrUnknown(result.unit))}};
  facts.insert(facts.end(), result.options.begin(), result.options.end());
  AddChanges(result.steps, result.certificate, facts);
  return facts;
}

std::string_view FactNamed(const MethodFacts& facts, std::string_view name) {
  const auto found = std::ranges::find(facts, name, &MethodFacts::value_type::first);
  return found == facts.end() ? std::string_view() : std::string_view(found->second);
}

void AddComments(Text& text, const MethodFacts& facts) {
  for (const auto& [name, value] : facts) text.Add("# ", name, ": ", OnOneLine(value), '\n');
}

std::string OptionsJson(const SkeletonizeOptions& options) {
  Text text;
  char before = '{';
  for (const OptionFact& fact : FactsOf(options)) {
    text.Add(before, JsonString(fact.name), ':');
    if (fact.type == OptionFact::Type::kNumber) {
      text.Add(fact.value);
    } else {
      text.Add(JsonString(fact.value));
    }
    before = ',';
  }
  return std::move(text.Add('}')).Take();
}

std::string PreparingJson(const std::vector<PreparingStep>& steps) {
  Text text;
  text.Add('[');
  for (const PreparingStep& step : steps) {
    text.Add(&step == steps.data() ? "" : ",", "{\"step\":\"", WordFor(kPreparingWords, step.kind),
             "\",\"count\":", step.count, ",\"points_added\":", step.points_added,
             ",\"points_removed\":", step.points_removed, '}');
  }
  return std::move(text.Add(']')).Take();
}

std::string PlacementJson(const Placement& placement) {
  Text text;
  const auto add = [&](std::string_view name, const auto& values) {
    text.Add(name);
    for (const double& value : values) text.Add(&value == values.data() ? '[' : ',', value);
    text.Add(']');
  };
  add("\"spacing\":", placement.spacing);
  add(",\"origin\":", placement.origin);
  add(",\"direction\":", placement.direction);
  return std::move(text).Take();
}

std::string BettiJson(const BettiNumbers& betti) {
  Text text;
  text.Add("{\"components\":", betti.components, ",\"loops\":", betti.loops,
           ",\"cavities\":", betti.cavities, '}');
  return std::move(text).Take();
}

std::string CertificateJson(const Certificate& certificate) {
  Text text;
  text.Add('{');
  if (certificate.mask.has_value()) text.Add("\"mask\":", BettiJson(*certificate.mask), ',');
  if (certificate.unprepared.has_value()) {
    text.Add("\"unprepared\":", BettiJson(*certificate.unprepared), ',');
  }
  text.Add("\"input\":", BettiJson(certificate.input),
           ",\"skeleton\":", BettiJson(certificate.skeleton));
  if (certificate.sampled) text.Add(",\"sampled\":true");
  text.Add(",\"simple_points_left\":", certificate.simple_points_left, '}');
  return std::move(text).Take();
}

}  // namespace bccskel::exporting
