#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/quality/studies.h"

// Usage: bccskel_quality figures|masks|rotations|reconstruction|voxels POINTS TURNS
//        bccskel_quality mesh POINTS TURNS FILE

namespace {

absl::Status Run(const std::string& study, const bccskel::quality::StudySize& size,
                 const std::string& file) {
  using namespace bccskel::quality;
  if (study == "figures") return StudyFigures(size);
  if (study == "masks") return StudyMasks(size);
  if (study == "rotations") return StudyRotations(size);
  if (study == "reconstruction") return StudyReconstruction(size);
  if (study == "voxels") return PrintVoxels(size);
  if (study == "mesh") return StudyMesh(size, file);
  return absl::InvalidArgumentError("no study is named \"" + study + "\"");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: %s STUDY POINTS TURNS [FILE]\n", argv[0]);
    return 2;
  }
  const bccskel::quality::StudySize size = {.points = std::strtoull(argv[2], nullptr, 10),
                                            .turns = std::atoi(argv[3])};
  const absl::Status status = Run(argv[1], size, argc > 4 ? argv[4] : "");
  if (status.ok()) return 0;
  std::fprintf(stderr, "%s\n", status.ToString().c_str());
  return 1;
}
