#ifndef BCCSKEL_CLIENT_CLI_VOLUME_SUMMARY_H_
#define BCCSKEL_CLIENT_CLI_VOLUME_SUMMARY_H_

#include <optional>
#include <string>

#include "core/certificate/certificate.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// Everything that is known about a volume, a line each; and the same as a JSON object. Betti
// numbers where they have been counted.
std::string VolumeText(const Volume& volume, const std::optional<BettiNumbers>& betti);
std::string VolumeJson(const Volume& volume, const std::optional<BettiNumbers>& betti);

std::string BettiJson(const BettiNumbers& betti);

// "spacing":[...],"origin":[...],"direction":[...]
std::string PlacementJson(const Placement& placement);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_VOLUME_SUMMARY_H_
