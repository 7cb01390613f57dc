#ifndef BCCSKEL_CLIENT_CLI_SWC_ARGUMENT_H_
#define BCCSKEL_CLIENT_CLI_SWC_ARGUMENT_H_

#include "client/export/point_forest.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// --swc-step.
void AddSwcStep(CLI::App& command, exporting::CurveSampling& sampling);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_SWC_ARGUMENT_H_
