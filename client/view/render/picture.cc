#include "client/view/render/picture.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "client/export/picture/beads.h"
#include "client/export/picture/caption.h"
#include "client/export/picture/glass_image.h"
#include "client/view/sheet_surface.h"
#include "core/certificate/describe_changes.h"
#include "core/exec/status_macros.h"

namespace bccskel::view {
namespace {

using exporting::Geometry, exporting::LinearColor;

constexpr int kSamplesPerPixel = 3;  // along each axis

// Space for text above and below the object, in font sizes.
constexpr double kWordsAbove = 6, kWordsBelow = 4;
double FontSize(const PictureOptions& options) {
  return std::max(11.0, std::min(options.width, options.height) / 56.0);
}

exporting::Projection ProjectionOf(const ResultDocument& result, const DisplaySurface& surface,
                                   const std::vector<WorldPoint>& shown,
                                   const PictureOptions& options) {
  const Front front = FrontOf(result, surface.vertices);
  const double words = (kWordsAbove + kWordsBelow) * FontSize(options);
  return exporting::Projection(
      ViewFrom(front.view, options.turn.value_or(front.turn), options.climb.value_or(front.climb)),
      shown,
      {static_cast<double>(kSamplesPerPixel * options.width),
       kSamplesPerPixel * std::max(options.height - words, options.height / 2.0)},
      kSamplesPerPixel * FontSize(options));
}

// Many curves must be thinner to stay distinguishable.
double ThinnedBy(const ResultDocument& result, const std::vector<WorldPoint>& shown) {
  if (shown.empty()) return 1;
  const auto [low, high] = BoxOf(shown);
  double edge = 0, length = 0;
  for (size_t axis = 0; axis < 3; ++axis) edge = std::max(edge, high[axis] - low[axis]);
  for (const ResultDocument::Edge& e : result.edges) length += e.length;
  return length > 6 * edge ? std::max(0.35, std::sqrt(6 * edge / length)) : 1;
}

// Normals of a mesh without consistent orientation: those around a vertex are flipped to agree. Not
// normalized.
std::vector<exporting::ViewNormal> NormalsOfEitherSide(const SurfaceMesh& mesh) {
  std::vector<exporting::ViewNormal> normals(mesh.vertices.size(), exporting::ViewNormal{});
  for (const SurfaceTriangle& t : mesh.triangles) {
    const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const exporting::ViewNormal u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const exporting::ViewNormal v = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const exporting::ViewNormal n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                     u[0] * v[1] - u[1] * v[0]};
    for (const uint32_t corner : t) {
      exporting::ViewNormal& sum = normals[corner];
      const float sign = sum[0] * n[0] + sum[1] * n[1] + sum[2] * n[2] < 0 ? -1.0f : 1.0f;
      for (size_t axis = 0; axis < 3; ++axis) sum[axis] += sign * n[axis];
    }
  }
  for (exporting::ViewNormal& n : normals) {
    if (n[2] < 0) n = {-n[0], -n[1], -n[2]};
  }
  return normals;
}

absl::StatusOr<Geometry> GeometryOf(const ResultDocument& result, const DisplaySurface& surface,
                                    const PictureOptions& options, const exec::Context& context) {
  const std::vector<WorldPoint> shown = ShownPoints(result, surface.vertices);
  const exporting::Projection projection = ProjectionOf(result, surface, shown, options);
  Geometry geometry = exporting::GlassOf(surface, projection);
  SheetSurface sheets = SheetSurfaceOf(result);
  geometry.sheets.mesh = {exporting::VerticesOf(sheets.vertices, projection),
                          std::move(sheets.triangles)};
  geometry.sheets.normals = NormalsOfEitherSide(geometry.sheets.mesh);
  BCCSKEL_ASSIGN_OR_RETURN(const exporting::BeadStrings strings,
                           exporting::BeadStrings::Of(result, context));
  const exporting::CurveColors& colors = strings.colors();
  for (size_t n = 0; n < sheets.radii.size(); ++n) {
    geometry.sheets.colors.push_back(
        colors.Linear(colors.NumberOf(sheets.labels, n, sheets.radii[n])));
  }
  const double thickness =
      kSamplesPerPixel * std::min(options.width, options.height) / 320.0 * ThinnedBy(result, shown);
  BCCSKEL_ASSIGN_OR_RETURN(geometry.beads, strings.In(projection, thickness, context));
  const auto above = static_cast<float>(kSamplesPerPixel * kWordsAbove * FontSize(options));
  for (SurfaceVertex& v : geometry.glass.vertices) v[1] -= above;
  for (SurfaceVertex& v : geometry.sheets.mesh.vertices) v[1] -= above;
  for (std::vector<exporting::Bead>& part : geometry.beads) {
    for (exporting::Bead& bead : part) bead.y += above;
  }
  return geometry;
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Pen = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

// Text and a legend around the object.
class Words {
 public:
  Words(cairo_t* pen, const PictureOptions& options)
      : pen_(pen), width_(options.width), height_(options.height), size_(FontSize(options)) {}

  void AddTitle(const ResultDocument& result, const std::string& title) {
    constexpr LinearColor kInk = {0.06f, 0.09f, 0.16f};
    WriteFitting(title, 2.4 * size_, 1.5, kInk, CAIRO_FONT_WEIGHT_BOLD);
    const std::string labels =
        result.labels.has_value()
            ? exporting::Counted(result.labels->names.size(), "label", "labels") + ", "
            : "";
    const std::string object = labels + exporting::GroupedDigits(result.object_points) +
                               " points, " + exporting::BettiPhrase(result.certificate.input);
    const std::string skeleton =
        "skeleton: " + exporting::Counted(result.edges.size(), "branch", "branches") + ", " +
        VerdictInWords(result.certificate);
    const std::string both = object + "; " + skeleton;
    if (WidthOf(both, 1, CAIRO_FONT_WEIGHT_NORMAL) <= Room()) {
      WriteFitting(both, 4.4 * size_, 1, kSoft, CAIRO_FONT_WEIGHT_NORMAL);
      return;
    }
    constexpr size_t kMostLines = 3;  // above the object; the last one holds all other words
    std::vector<std::string> lines = LinesOf(object + "\n" + skeleton);
    for (; lines.size() > kMostLines; lines.pop_back()) {
      lines[lines.size() - 2] += " " + lines.back();
    }
    for (size_t n = 0; n < lines.size(); ++n) {
      const double y = 4.1 + 1.35 * static_cast<double>(n);
      WriteFitting(lines[n], y * size_, 1, kSoft, CAIRO_FONT_WEIGHT_NORMAL);
    }
  }

  void AddLegend(const ResultDocument& result) {
    if (result.nodes.empty()) return;
    const double base = height_ - 1.8 * size_;
    double x = result.labels.has_value()
                   ? Label("each label in its own color", kMargin * size_, base)
                   : RadiusLegend(exporting::RadiusRangeOf(result), result, base);
    const auto has = [&](std::string_view kind) {
      return std::ranges::any_of(result.nodes, [&](const auto& node) { return node.kind == kind; });
    };
    if (has("end")) x = Dot("end", exporting::kEndColor, x + size_, base);
    if (has("junction")) x = Dot("junction", exporting::kJunctionColor, x + size_, base);
    if (has("isolated") || has("closed_surface"))
      Dot("other", exporting::kOtherColor, x + size_, base);
  }

 private:
  static constexpr double kMargin = 1.6;  // in font sizes
  static constexpr LinearColor kSoft = {0.28f, 0.33f, 0.41f};

  // Returns the x coordinate of its end.
  double RadiusLegend(const exporting::RadiusRange& radii, const ResultDocument& result,
                      double base) {
    const double x = Label("radius " + Figure(radii.low), kMargin * size_, base);
    cairo_set_antialias(pen_, CAIRO_ANTIALIAS_NONE);  // no seams
    for (int n = 0; n < exporting::kRadiusColors; ++n) {
      const auto rgb = exporting::RadiusRgb(n);
      cairo_set_source_rgb(pen_, rgb[0] / 255, rgb[1] / 255, rgb[2] / 255);
      cairo_rectangle(pen_, x + 0.45 * size_ * n, base - 0.75 * size_, 0.45 * size_, 0.8 * size_);
      cairo_fill(pen_);
    }
    cairo_set_antialias(pen_, CAIRO_ANTIALIAS_DEFAULT);
    return Label(Figure(radii.high) + exporting::UnitBehind(result),
                 x + (0.45 * exporting::kRadiusColors + 0.7) * size_, base);
  }

  double Room() const { return width_ - 2 * kMargin * size_; }

  double WidthOf(const std::string& words, double scale, cairo_font_weight_t weight) {
    cairo_select_font_face(pen_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, weight);
    cairo_set_font_size(pen_, scale * size_);
    cairo_text_extents_t extents;
    cairo_text_extents(pen_, words.c_str(), &extents);
    return extents.x_advance;
  }

  // The lines of a text, each broken before the word with which it would be too wide.
  std::vector<std::string> LinesOf(const std::string& text) {
    std::vector<std::string> lines;
    for (const std::string& given : std::vector<std::string>(absl::StrSplit(text, '\n'))) {
      std::string line;
      for (const std::string& word : std::vector<std::string>(absl::StrSplit(given, ' '))) {
        std::string longer = absl::StrCat(line, line.empty() ? "" : " ", word);
        if (!line.empty() && WidthOf(longer, 1, CAIRO_FONT_WEIGHT_NORMAL) > Room()) {
          lines.push_back(std::move(line));
          longer = word;
        }
        line = std::move(longer);
      }
      lines.push_back(std::move(line));
    }
    return lines;
  }

  // A line of text from the left margin, in a smaller font if it would not fit.
  void WriteFitting(const std::string& words, double y, double scale, const LinearColor& color,
                    cairo_font_weight_t weight) {
    const double width = WidthOf(words, scale, weight);
    if (width > Room()) scale *= Room() / width;
    Write(words, kMargin * size_, y, scale, color, weight);
  }

  // Returns the x coordinate of the text's end.
  double Write(const std::string& words, double x, double y, double scale, const LinearColor& color,
               cairo_font_weight_t weight) {
    const double width = WidthOf(words, scale, weight);
    cairo_set_source_rgb(pen_, color[0], color[1], color[2]);
    cairo_move_to(pen_, x, y);
    cairo_show_text(pen_, words.c_str());
    return x + width;
  }
  double Label(const std::string& words, double x, double y) {
    return Write(words, x, y, 1, kSoft, CAIRO_FONT_WEIGHT_NORMAL) + 0.7 * size_;
  }
  double Dot(const std::string& words, const LinearColor& color, double x, double y) {
    cairo_set_source_rgb(pen_, color[0], color[1], color[2]);
    cairo_arc(pen_, x + 0.4 * size_, y - 0.35 * size_, 0.4 * size_, 0, 2 * std::numbers::pi);
    cairo_fill(pen_);
    return Label(words, x + 1.2 * size_, y);
  }
  static std::string Figure(double value) { return absl::StrFormat("%.3g", value); }

  cairo_t* pen_;
  double width_;
  double height_;
  double size_;
};

// Cairo fails on text that is not UTF-8, such as some file names.
bool CanWrite(cairo_surface_t* image, const std::string& words) {
  const Pen pen(cairo_create(image), &cairo_destroy);
  cairo_text_extents_t extents;
  cairo_text_extents(pen.get(), words.c_str(), &extents);
  return cairo_status(pen.get()) == CAIRO_STATUS_SUCCESS;
}

absl::Status CheckCairo(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return absl::OkStatus();
  return absl::ResourceExhaustedError(std::string("Cairo: ") + cairo_status_to_string(status));
}

}  // namespace

absl::StatusOr<std::string> RenderPng(const ResultDocument& result, const DisplaySurface& surface,
                                      const PictureOptions& options, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const Geometry geometry, GeometryOf(result, surface, options, context));
  BCCSKEL_ASSIGN_OR_RETURN(
      exporting::RgbImage image,
      exporting::ImageOf(geometry, options.width, options.height, kSamplesPerPixel, context));
  const Surface drawn(cairo_image_surface_create_for_data(
                          reinterpret_cast<unsigned char*>(image.pixels.data()), CAIRO_FORMAT_RGB24,
                          image.width, image.height, 4 * image.width),
                      &cairo_surface_destroy);
  const Pen pen(cairo_create(drawn.get()), &cairo_destroy);
  Words words(pen.get(), options);
  words.AddTitle(result, CanWrite(drawn.get(), options.title) ? options.title : "");
  words.AddLegend(result);
  BCCSKEL_RETURN_IF_ERROR(CheckCairo(cairo_status(pen.get())));
  cairo_surface_flush(drawn.get());
  return exporting::PngOf(image);
}

}  // namespace bccskel::view
