#ifndef BCCSKEL_CORE_CERTIFICATE_DESCRIBE_CHANGES_H_
#define BCCSKEL_CORE_CERTIFICATE_DESCRIBE_CHANGES_H_

#include <string>

#include "core/certificate/certificate.h"

namespace bccskel {

// Describes a change of topology, such as "components 1 -> 3, loops 2 -> 7"; empty if nothing
// changed.
std::string DescribeChanges(const BettiNumbers& before, const BettiNumbers& after);

// What the certificate proves, in words: "topology kept", or which steps before thinning changed it
// and how.
std::string VerdictInWords(const Certificate& certificate);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_DESCRIBE_CHANGES_H_
