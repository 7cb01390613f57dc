#include <vector>

#include "core/exec/status_macros.h"
#include "core/io/bricks_header.h"
#include "core/io/encoded_body.h"
#include "core/io/volume_writers.h"

namespace bccskel {
namespace {

constexpr size_t kRecordsAtOnce = 4096;

}  // namespace

absl::Status WriteBricks(const Volume& volume, VolumeCompression compression, ByteSink& sink,
                         const exec::Context& context) {
  SinkCursor cursor(sink);
  BCCSKEL_RETURN_IF_ERROR(cursor.Write(EncodeBricksHeader(volume, compression)));
  BodyWriter body(compression, cursor);
  std::vector<std::byte> records;
  for (size_t n = 0; n < volume.brick_count(); ++n) {
    const auto record = EncodeBrickRecord(volume.keys()[n], volume.bricks()[n]);
    records.insert(records.end(), record.begin(), record.end());
    if (records.size() < kRecordsAtOnce * kBrickRecordBytes) continue;
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    BCCSKEL_RETURN_IF_ERROR(body.Write(records));
    records.clear();
  }
  BCCSKEL_RETURN_IF_ERROR(body.Write(records));
  return body.Finish();
}

}  // namespace bccskel
