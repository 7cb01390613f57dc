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

const char* WordsFor(ObjectSource source) {
  switch (source) {
    case ObjectSource::kPoints:
      return "";
    case ObjectSource::kVoxels:
      return ", of a mask converted exactly at 2 points per voxel";
    case ObjectSource::kRefinedVoxels:
      return ", of a mask converted exactly at 16 points per voxel";
    case ObjectSource::kSampledVoxels:
      return ", of a sampled mask, whose topology may have changed";
  }
  return "";
}

}  // namespace

std::string MethodInWords(const ThinningOptions& thinning, DistanceKind distance,
                          ObjectSource source) {
  return absl::StrFormat(
      "%s by parallel %s thinning on the body-centered cubic grid by %s shells%s",
      WordsFor(thinning.kind), WordsFor(thinning.method), WordsFor(distance), WordsFor(source));
}

}  // namespace bccskel
