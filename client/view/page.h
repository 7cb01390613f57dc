#ifndef BCCSKEL_CLIENT_VIEW_PAGE_H_
#define BCCSKEL_CLIENT_VIEW_PAGE_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/view/display_surface.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"

namespace bccskel::view {

struct PageContent {
  std::string title;  // plain text in any encoding
  const ResultDocument& result;
  const Peeling& peeling;  // without layers: the skeleton alone
};

// A self-contained page that a browser opens without a network: the object as tinted glass, its
// skeleton and tools for both. Equal skeletons give equal bytes.
// Surfaces are quantized to 16 bits across the object, curves to 22. The page contains the
// skeleton's document without its timings; points are stored apart, sheets as a surface.
// Errors: RESOURCE_EXHAUSTED; those of the context.
absl::StatusOr<std::string> PageOf(const PageContent& content, const exec::Context& context = {});

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_PAGE_H_
