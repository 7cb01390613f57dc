#include "core/import/image/tiff_stack.h"

#include <algorithm>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/axis_units.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_choice.h"

namespace bccskel {
namespace {

// An axis of pages, by the letter that OME and tifffile give it: Z, C or T.
struct PageAxis {
  char letter;
  int64_t length;
};

// Many programs name the only axis of pages a channel or time unless told otherwise.
absl::StatusOr<int64_t> ChosenPage(const PageAxis& axis, const std::vector<PageAxis>& axes,
                                   const ImageOptions& options) {
  absl::StatusOr<int64_t> chosen = ChosenAlong(axis.letter, axis.length, options);
  const bool stated = (axis.letter == 'C' ? options.channel : options.time).has_value();
  const auto is_long = [](const PageAxis& other) { return other.length > 1; };
  if (chosen.ok() || stated || std::ranges::count_if(axes, is_long) != 1) return chosen;
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s; if they are slices, save them as such (tifffile: metadata={'axes': 'ZYX'}) or as .npy",
      chosen.status().message()));
}

// What one slice axis and the axes to choose from come to. `axes` are fastest first.
absl::StatusOr<TiffStack> Select(const std::vector<PageAxis>& axes, int64_t pages,
                                 const ImageOptions& options) {
  TiffStack stack;
  int64_t step = 1;
  for (const PageAxis& axis : axes) {
    // No product overflows: what has more planes than the file has pages ends here.
    if (axis.length < 1 || axis.length > pages / step) {
      return absl::InvalidArgumentError(
          absl::StrFormat("the description declares %d along %c, more than the %d pages hold",
                          axis.length, axis.letter, pages));
    }
    if (axis.letter == 'Z') {
      stack.slices = axis.length;
      stack.page_step = step;
    } else {
      BCCSKEL_ASSIGN_OR_RETURN(const int64_t chosen, ChosenPage(axis, axes, options));
      stack.first_page += chosen * step;
    }
    step *= axis.length;
  }
  if (step == pages) return stack;
  return absl::InvalidArgumentError(
      absl::StrFormat("the description declares %d planes, the file has %d pages", step, pages));
}

int64_t CountOr(std::string_view text, int64_t otherwise) {
  return ParseNumber<int64_t>(text).value_or(otherwise);
}

// ImageJ's hyperstacks: channels fastest, then slices, then frames.
absl::StatusOr<TiffStack> ImageJStack(std::string_view description, int64_t pages,
                                      const ImageOptions& options) {
  int64_t images = 1, channels = 1, slices = 0, frames = 1;
  double spacing = 1;
  std::array<std::optional<std::string>, 3> units;  // that of x is that of all which state none
  for (const std::string_view line : Words(description)) {
    const auto field = SplitAt(line, "=");
    if (!field.has_value()) continue;
    const auto& [key, value] = *field;
    if (key == "images") images = CountOr(value, 1);
    if (key == "channels") channels = CountOr(value, 0);
    if (key == "slices") slices = CountOr(value, 0);
    if (key == "frames") frames = CountOr(value, 0);
    if (key == "spacing") spacing = ParseNumber<double>(value).value_or(1);
    if (key == "unit" && value != "inch") units[0] = value;
    if (key == "yunit") units[1] = value;
    if (key == "zunit") units[2] = value;
  }
  if (pages == 1 && images > 1) {
    return absl::UnimplementedError(absl::StrFormat(
        "an ImageJ stack of %d images behind one page is not supported: save it as BigTIFF or NRRD",
        images));
  }
  const bool plain = channels == 1 && frames == 1;
  if (plain) slices = pages;  // some writers state no slices
  if (slices == 0) slices = 1;
  BCCSKEL_ASSIGN_OR_RETURN(TiffStack stack,
                           Select({{'C', channels}, {'Z', slices}, {'T', frames}}, pages, options));
  if (!units[0].has_value() || units[0]->empty()) return stack;
  for (std::optional<std::string>& unit : units) unit = unit.value_or(*units[0]);
  BCCSKEL_ASSIGN_OR_RETURN(const CommonUnit common, CommonUnitOf(units));
  stack.unit = common.unit;
  stack.factors = common.factors;
  stack.spacing[2] = spacing * common.factors[2];
  stack.has_resolution_tags = true;
  return stack;
}

// The value of an attribute in the text of an XML tag; nothing where there is none.
std::optional<std::string_view> Attribute(std::string_view tag, std::string_view name) {
  const std::string opening = absl::StrFormat(" %s=\"", std::string(name));
  const size_t at = tag.find(opening);
  if (at == tag.npos) return std::nullopt;
  const std::string_view value = tag.substr(at + opening.size());
  const size_t end = value.find('"');
  return end == value.npos ? std::nullopt : std::optional(value.substr(0, end));
}

// The text of the first tag of a name, which may have a prefix (ome:Pixels), from behind the name
// on.
std::optional<std::string_view> TagOf(std::string_view xml, std::string_view name) {
  for (size_t at = xml.find(name); at != xml.npos; at = xml.find(name, at + 1)) {
    const std::string_view tag = xml.substr(at + name.size());
    const size_t opened = xml.substr(0, at).find_last_of("< />\"'");
    const bool opens =
        opened != xml.npos && xml[opened] == '<' && (opened + 1 == at || xml[at - 1] == ':');
    if (opens && (tag.starts_with(' ') || tag.starts_with('>')))
      return tag.substr(0, tag.find('>'));
  }
  return std::nullopt;
}

absl::Status TakePhysicalSize(std::string_view pixels, TiffStack& stack) {
  std::array<std::optional<std::string>, 3> units;
  for (size_t axis = 0; axis < 3; ++axis) {
    const std::string name = absl::StrFormat("PhysicalSize%c", "XYZ"[axis]);
    const auto size = Attribute(pixels, name);
    if (!size.has_value()) continue;
    BCCSKEL_ASSIGN_OR_RETURN(stack.spacing[axis], RequireNumber<double>(name, *size));
    units[axis] = Attribute(pixels, name + "Unit").value_or("\xc2\xb5m");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const CommonUnit common, CommonUnitOf(units));
  stack.unit = common.unit;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (stack.spacing[axis].has_value()) *stack.spacing[axis] *= common.factors[axis];
  }
  return absl::OkStatus();
}

absl::StatusOr<TiffStack> OmeStack(std::string_view xml, int64_t pages,
                                   const ImageOptions& options) {
  const auto pixels = TagOf(xml, "Pixels");
  if (!pixels.has_value()) {
    return absl::UnimplementedError(
        "an OME-TIFF without a Pixels element, as of the parts of a larger set, is not supported");
  }
  const std::string_view order = Attribute(*pixels, "DimensionOrder").value_or("");
  const bool known = order.size() == 5 && order.starts_with("XY") &&
                     order.find('Z') != order.npos && order.find('C') != order.npos &&
                     order.find('T') != order.npos;
  if (!known) return BadField("DimensionOrder", order, "is not one of XYZCT, XYCZT, ...");
  std::vector<PageAxis> axes;
  int64_t planes = 1;
  for (const char letter : order.substr(2)) {
    const std::string name = absl::StrFormat("Size%c", letter);
    const std::string_view text = Attribute(*pixels, name).value_or("1");
    BCCSKEL_ASSIGN_OR_RETURN(const int64_t length, RequireNumber<int64_t>(name, text));
    axes.push_back({letter, length});
    planes = length > 0 && planes <= pages ? planes * std::min(length, pages + 1) : planes;
  }
  if (planes > pages) {
    return absl::UnimplementedError(
        absl::StrFormat("the OME description declares more planes than the %d pages here; sets of "
                        "several files are not supported",
                        pages));
  }
  BCCSKEL_ASSIGN_OR_RETURN(TiffStack stack, Select(axes, pages, options));
  BCCSKEL_RETURN_IF_ERROR(TakePhysicalSize(*pixels, stack));
  return stack;
}

// The text behind "key": in a flat JSON object.
std::string_view JsonValue(std::string_view json, std::string_view key) {
  const std::string quoted = absl::StrFormat("\"%s\":", std::string(key));
  const size_t at = json.find(quoted);
  return at == json.npos ? std::string_view() : Trimmed(json.substr(at + quoted.size()));
}

// The lengths of the axes that pages go along, slowest first.
absl::StatusOr<std::vector<int64_t>> ShapedAxes(std::string_view json) {
  const std::string_view list = JsonValue(json, "shape");
  const size_t end = list.find(']');
  if (!list.starts_with('[') || end == list.npos) {
    return absl::InvalidArgumentError("the description's shape is not a list of numbers");
  }
  std::vector<int64_t> shape;
  for (const std::string_view word : Words(list.substr(1, end - 1), ",")) {
    BCCSKEL_ASSIGN_OR_RETURN(shape.emplace_back(), RequireNumber<int64_t>("shape", word));
  }
  return shape;
}

// The letters that tifffile's user named the axes by; "" where they were not named.
std::string_view ShapedLetters(std::string_view json) {
  std::string_view text = JsonValue(json, "axes");
  if (!text.starts_with('"')) return "";
  text.remove_prefix(1);
  return text.substr(0, text.find('"'));
}

// Whether all axes but the last two are those of the pages.
bool PagesGoAlong(const std::vector<int64_t>& shape, int64_t pages) {
  int64_t planes = 1;
  for (size_t n = 0; n + 2 < shape.size(); ++n) {
    if (shape[n] < 1 || shape[n] > pages / planes) return false;
    planes *= shape[n];
  }
  return planes == pages;
}

absl::StatusOr<TiffStack> ShapedStack(std::string_view json, int64_t pages,
                                      const ImageOptions& options) {
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<int64_t> shape, ShapedAxes(json));
  std::string letters(ShapedLetters(json));
  if (letters.size() != shape.size()) letters.assign(shape.size(), '?');
  // Axes of length 1 behind those of a page, as of a single value per voxel.
  while (shape.size() > 2 && shape.back() == 1 && !PagesGoAlong(shape, pages)) {
    shape.pop_back();
    letters.pop_back();
  }
  std::vector<PageAxis> axes;  // slowest first
  for (size_t n = 0; n + 2 < shape.size(); ++n) {
    if (shape[n] != 1) axes.push_back({letters[n], shape[n]});
  }
  // One axis without a name is that of slices; of two, the first is taken for that of channels.
  if (axes.size() == 1 && axes[0].letter == '?') axes[0].letter = 'Z';
  if (axes.size() == 2 && axes[0].letter == '?') axes[0].letter = 'C';
  if (axes.size() == 2 && axes[1].letter == '?') axes[1].letter = 'Z';
  std::string seen;
  for (const PageAxis& axis : axes) {
    const bool usable = (axis.letter == 'Z' || axis.letter == 'C' || axis.letter == 'T') &&
                        seen.find(axis.letter) == seen.npos;
    if (!usable) {
      return absl::UnimplementedError(absl::StrFormat(
          "the description's shape has an axis %c, or more axes than Z, C and T; save the volume "
          "alone, or with its axes named",
          axis.letter));
    }
    seen += axis.letter;
  }
  if (pages == 1 && !axes.empty()) {
    return absl::UnimplementedError(
        "the description names more pages than the one there is: the file is cut, or a stack "
        "behind "
        "one page, as tifffile writes with truncate=True, which is not supported");
  }
  return Select({axes.rbegin(), axes.rend()}, pages, options);
}

}  // namespace

absl::StatusOr<TiffStack> TiffStackOf(std::string_view description, int64_t pages,
                                      const ImageOptions& options) {
  if (description.starts_with("ImageJ=")) return ImageJStack(description, pages, options);
  if (description.starts_with('<') && TagOf(description, "OME").has_value()) {
    return OmeStack(description, pages, options);
  }
  if (description.starts_with("{") && !JsonValue(description, "shape").empty()) {
    return ShapedStack(description, pages, options);
  }
  if (options.channel.value_or(0) != 0 || options.time.value_or(0) != 0) {
    return absl::InvalidArgumentError(
        "--channel and --time apply to files whose description names their axes (OME, ImageJ, "
        "tifffile); this one names none");
  }
  TiffStack stack;
  stack.slices = pages;
  return stack;
}

}  // namespace bccskel
