#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_GLASS_COLOR_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_GLASS_COLOR_H_

#include "client/export/picture/band.h"

namespace bccskel::exporting {

inline constexpr LinearColor kPaperColor = {0.973f, 0.980f, 0.988f};

// The color of a sample: the paper, the object's far side, the skeleton and the object's near side,
// composited in this order.
LinearColor ColorAt(const Band& band, int x, int row);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_GLASS_COLOR_H_
