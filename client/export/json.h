#ifndef BCCSKEL_CLIENT_EXPORT_JSON_H_
#define BCCSKEL_CLIENT_EXPORT_JSON_H_

#include <optional>
#include <string>

#include "client/export/world.h"
#include "core/exec/context.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::exporting {

// The JSON document of client/export/skeleton.schema.json: nodes, edges, components, certificate,
// how it was made, timings, sha256. World coordinates and units.
// With an order of trees, nodes and edges state their places in it.
// Nodes and edges are written on all threads of the context. After a stop request it returns early,
// with a part of the document.
// kForPage: without what a page lacks or holds in another form, ResultDocument::not_on_pages.
enum class JsonParts { kAll, kForPage };
std::string JsonText(const SkeletonizeResult& result,
                     const std::optional<TreeOrder>& order = std::nullopt, const World& world = {},
                     JsonParts parts = JsonParts::kAll, const exec::Context& context = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_JSON_H_
