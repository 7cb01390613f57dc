#ifndef BCCSKEL_CLIENT_EXPORT_METHOD_FACTS_H_
#define BCCSKEL_CLIENT_EXPORT_METHOD_FACTS_H_

#include <string>
#include <utility>
#include <vector>

#include "client/export/world.h"
#include "client/view/result_graph.h"
#include "core/certificate/certificate.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::exporting {

// How a result was made: names and values for formats that hold no structure. The first is `method`
// in words, the second `algorithm_version`, then come `world` and `unit`, "unknown" where the input
// does not tell, and the options; `prepared` has what preparing did. Plain text, no quotes.
using MethodFacts = std::vector<std::pair<std::string, std::string>>;
MethodFacts MethodFactsOf(const SkeletonizeResult& result, const World& world = {});
// Of a result that was read again.
MethodFacts MethodFactsOf(const view::ResultGraph& result);

// The same as JSON values: an object of the options, and a list of the steps of preparing.
std::string OptionsJson(const SkeletonizeOptions& options);
std::string PreparingJson(const std::vector<PreparingStep>& steps);

// An object of three numbers, and one of those of mask, object and skeleton.
std::string BettiJson(const BettiNumbers& betti);
std::string CertificateJson(const Certificate& certificate);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_METHOD_FACTS_H_
