#ifndef BCCSKEL_CLIENT_VIEW_PAGE_PARTS_H_
#define BCCSKEL_CLIENT_VIEW_PAGE_PARTS_H_

#include <string_view>

namespace bccskel::view {

// The files of the folder `page`.
extern const std::string_view kPageFrame;  // with {{style}}, {{license}}, {{three}}, ... to fill in
extern const std::string_view kPageStyle;
extern const std::string_view kLoaderScript;
extern const std::string_view kViewerScripts;
extern const std::string_view kThreeLicense;

// three.js, as Debian packages it.
extern const std::string_view kThree;

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_PAGE_PARTS_H_
