#ifndef BCCSKEL_TESTS_SUPPORT_ENUM_VALUES_H_
#define BCCSKEL_TESTS_SUPPORT_ENUM_VALUES_H_

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace bccskel::test {

// Compilers write a value without a name as a number: "kValue = (bccskel::Border)7".
template <typename Enum, Enum kValue>
constexpr bool HasName() {
  constexpr std::string_view kBefore = "kValue = ";
  const std::string_view text = __PRETTY_FUNCTION__;
  const char first = text[text.rfind(kBefore) + kBefore.size()];
  return first != '(' && (first < '0' || first > '9');
}

// Every value of the enum that has a name, of 0 to 31.
template <typename Enum>
std::vector<Enum> ValuesOf() {
  std::vector<Enum> values;
  [&]<size_t... kNumbers>(std::index_sequence<kNumbers...>) {
    const auto add = [&](bool named, Enum value) {
      if (named) values.push_back(value);
    };
    (add(HasName<Enum, static_cast<Enum>(kNumbers)>(), static_cast<Enum>(kNumbers)), ...);
  }
  (std::make_index_sequence<32>());
  return values;
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_ENUM_VALUES_H_
