#include "core/pipeline/method_in_words.h"

#include "absl/strings/str_format.h"

namespace bccskel {
namespace {

const char* WordsFor(SkeletonKind kind) {
  switch (kind) {
    case SkeletonKind::kCurve:
      return "curve skeleton";
    case SkeletonKind::kSurface:
      return "surface skeleton";
    case SkeletonKind::kKernel:
      return "topological kernel";
    case SkeletonKind::kIsthmusCurve:
      return "curve skeleton of isthmuses";
  }
  return "";
}

const char* WordsFor(ThinningMethod method) {
  switch (method) {
    case ThinningMethod::kDirectional:
      return "directional";
    case ThinningMethod::kDirectionalAlternating:
      return "directional (order of directions alternating)";
    case ThinningMethod::kSymmetric:
      return "symmetric";
  }
  return "";
}

const char* WordsFor(DistanceKind distance) {
  switch (distance) {
    case DistanceKind::kChamfer:
      return "chamfer";
    case DistanceKind::kChamferOptimal:
      return "optimal chamfer";
    case DistanceKind::kEuclidean:
      return "Euclidean";
  }
  return "";
}

}  // namespace

std::string MethodInWords(const ThinningOptions& thinning, DistanceKind distance) {
  return absl::StrFormat("%s by parallel %s thinning on the body-centered cubic grid by %s shells",
                         WordsFor(thinning.kind), WordsFor(thinning.method), WordsFor(distance));
}

}  // namespace bccskel
