#ifndef BCCSKEL_TESTS_PROTO_MESSAGE_ENUMERATORS_H_
#define BCCSKEL_TESTS_PROTO_MESSAGE_ENUMERATORS_H_

#include <google/protobuf/message.h>

namespace bccskel::test {

// Gives each field of `message` that is an enumerator one after the other of its type and calls
// `visit(field, enumerator)`, both descriptors.
template <typename Visit>
void ForEachEnumerator(google::protobuf::Message& message, Visit visit) {
  const auto& reflection = *message.GetReflection();
  const auto& type = *message.GetDescriptor();
  for (int n = 0; n < type.field_count(); ++n) {
    const auto& field = *type.field(n);
    if (field.enum_type() == nullptr || field.is_repeated()) continue;
    const auto* before = reflection.GetEnum(message, &field);
    for (int value = 0; value < field.enum_type()->value_count(); ++value) {
      reflection.SetEnum(&message, &field, field.enum_type()->value(value));
      visit(field, *field.enum_type()->value(value));
    }
    reflection.SetEnum(&message, &field, before);
  }
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_PROTO_MESSAGE_ENUMERATORS_H_
