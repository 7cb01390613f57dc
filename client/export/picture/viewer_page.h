#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_VIEWER_PAGE_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_VIEWER_PAGE_H_

#include <string_view>

namespace bccskel::exporting {

// The text of viewer.html, with {{title}}, {{object}}, {{skeleton}} and {{data}} to be filled in.
extern const std::string_view kViewerPage;

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_VIEWER_PAGE_H_
