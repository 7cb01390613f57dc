#ifndef BCCSKEL_CORE_IMPORT_IMAGE_ZIP_ARCHIVE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_ZIP_ARCHIVE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/byte_stream.h"
#include "core/import/image/image_file.h"

namespace bccskel {

bool IsZip(std::string_view front);

// The names of an archive's members, by their numbers.
// Errors: INVALID_ARGUMENT for a damaged or cut directory.
absl::StatusOr<std::vector<std::string>> ZipNames(std::shared_ptr<const ImageFile> file);

// The bytes of a member, expanded. Its end is where its check sum is compared.
// Errors: INVALID_ARGUMENT for a member that is damaged, encrypted or compressed in another way
//         than deflate.
absl::StatusOr<std::unique_ptr<ByteStream>> OpenZipMember(std::shared_ptr<const ImageFile> file,
                                                          uint64_t number);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_ZIP_ARCHIVE_H_
