#include "core/lattice/length_unit.h"

#include <algorithm>
#include <array>

namespace bccskel {
namespace {

struct LengthUnit {
  const char* unit;
  double nanometers;
  std::string_view names;  // between bars
};

// Micro and angstrom also have signs: in UTF-8 two of each, in Latin-1, in XML and as ImageJ's.
constexpr std::array<LengthUnit, 9> kLengthUnits = {{
    {"pm", 1e-3, "|pm|picometer|picometers|picometre|picometres|"},
    {"angstrom", 0.1, "|angstrom|angstroms|A|\xc3\x85|\xe2\x84\xab|\xc5|\\u00C5|\\u212B|"},
    {"nm", 1, "|nm|nanometer|nanometers|nanometre|nanometres|"},
    {"um", 1e3,
     "|um|micron|microns|micrometer|micrometers|micrometre|micrometres|\xc2\xb5m|\xce\xbcm|\xb5m|"
     "\\u00B5m|\\u00b5m|\\u03BCm|\\u03bcm|&#181;m|&#xb5;m|&#xB5;m|"},
    {"mm", 1e6, "|mm|millimeter|millimeters|millimetre|millimetres|"},
    {"cm", 1e7, "|cm|centimeter|centimeters|centimetre|centimetres|"},
    {"dm", 1e8, "|dm|decimeter|decimeters|decimetre|decimetres|"},
    {"m", 1e9, "|m|meter|meters|metre|metres|"},
    {"km", 1e12, "|km|kilometer|kilometers|kilometre|kilometres|"},
}};

const LengthUnit* Known(std::string_view name) {
  std::string wanted = "|";
  wanted.append(name).push_back('|');
  const auto* const entry = std::ranges::find_if(kLengthUnits, [&wanted](const LengthUnit& unit) {
    return unit.names.find(wanted) != std::string_view::npos;
  });
  return entry == kLengthUnits.end() ? nullptr : entry;
}

bool IsPlain(char c) {
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return letter || (c >= '0' && c <= '9') || c == ' ' || c == '_' || c == '-';
}

}  // namespace

std::string UnitNamed(std::string_view name) {
  if (const LengthUnit* known = Known(name)) return known->unit;
  constexpr size_t kLongest = 32;
  const bool plain = name.size() <= kLongest && std::ranges::all_of(name, IsPlain);
  return plain ? std::string(name) : std::string();
}

std::optional<double> NanometersOf(std::string_view unit) {
  const LengthUnit* const known = Known(unit);
  return known == nullptr ? std::nullopt : std::optional(known->nanometers);
}

}  // namespace bccskel
