#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_HTML_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_HTML_H_

#include <string>

#include "client/export/subject.h"

namespace bccskel::exporting {

// A self-contained page that any browser opens without a network: the object as tinted glass and
// its skeleton, to be turned with the mouse. Coordinates are quantized to 16 bits, and of a large
// surface a part is shown; every other format is exact.
std::string HtmlText(const Subject& subject);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_HTML_H_
