#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "tests/quality/studies.h"

// Usage: bccskel_quality STUDY [--points N,...] [--turns N] [--half tune|judge|all]
//        [--as bcc,mask] [--noise PERCENT,...] [--only NAME,...] [--data PLACE] [--dump FOLDER]
//        [--rule RULE] [--threshold X] [--merge-junctions X] [--kind KIND] [--json]

namespace {

absl::Status Run(const std::string& name, const std::vector<std::string>& arguments) {
  using namespace bccskel::quality;
  const std::map<std::string, absl::Status (*)(const StudyOptions&)> studies = {
      {"cut-limbs", StudyCutLimbs},
      {"image-faces", StudyImageFaces},
      {"figures", StudyFigures},
      {"rotations", StudyRotations},
      {"reconstruction", StudyReconstruction},
      {"mesh", StudyMesh},
      {"meshes", StudyClosedMeshes},
      {"real-masks", StudyRealMasks},
      {"spine-lengths", StudySpineLengths},
      {"thick-slices", StudyThickSlices},
      {"wild", StudyWild},
      {"voxels", PrintVoxels},
      {"real-voxels", PrintRealVoxels},
  };
  const auto study = studies.find(name);
  if (study == studies.end()) {
    std::string message = "no study is named \"" + name + "\"; there are";
    for (const auto& [known, run] : studies) message += " " + known;
    return absl::InvalidArgumentError(message);
  }
  const absl::StatusOr<StudyOptions> options = ParseStudyOptions(arguments);
  if (!options.ok()) return options.status();
  return study->second(*options);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s STUDY [--points N] [--turns N] ...\n", argv[0]);
    return 2;
  }
  const absl::Status status = Run(argv[1], {argv + 2, argv + argc});
  if (status.ok()) return 0;
  std::fprintf(stderr, "%s\n", status.ToString().c_str());
  return 1;
}
