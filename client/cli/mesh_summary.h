#ifndef BCCSKEL_CLIENT_CLI_MESH_SUMMARY_H_
#define BCCSKEL_CLIENT_CLI_MESH_SUMMARY_H_

#include <string>

#include "core/import/mesh/mesh_report.h"
#include "core/import/voxelize/voxelize.h"

namespace bccskel::cli {

// "2,775 vertices, 5,558 triangles, watertight, genus 3".
std::string MeshPhrase(const MeshReport& report);

// Everything that is known about a mesh, a line each; and the same as a JSON object.
std::string MeshText(const MeshReport& report);
std::string MeshJson(const MeshReport& report);

// "parity" or "winding".
std::string FillRuleName(FillRule rule);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_MESH_SUMMARY_H_
