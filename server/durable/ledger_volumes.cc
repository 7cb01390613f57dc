#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/durable/durable_ledger.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

VolumeInfo DurableLedger::InfoOf(const VolumeRow& row) const {
  return {.name = row.name,
          .declaration = row.declaration,
          .blob_digest = row.blob_digest,
          .volume_digest = row.volume_digest,
          .size_bytes = row.size_bytes,
          .created = row.created,
          .expires = row.used + options_.keep_volumes};
}

absl::StatusOr<VolumeRow> DurableLedger::FindVolumeRow(JobStore& store, const std::string& tenant,
                                                       const std::string& volume) const {
  BCCSKEL_ASSIGN_OR_RETURN(std::optional<VolumeRow> row, store.FindVolume(tenant, volume));
  if (row.has_value()) return *std::move(row);
  return absl::NotFoundError(absl::StrCat("there is no volume ", volume));
}

void DurableLedger::FindVolumes(const std::string& tenant, const std::vector<std::string>& digests,
                                Done<std::vector<VolumeInfo>> done) {
  Read<std::vector<VolumeInfo>>(
      [this, tenant, digests](JobStore& store) -> absl::StatusOr<std::vector<VolumeInfo>> {
        std::vector<VolumeInfo> found;
        for (const std::string& digest : digests) {
          if (digest.empty()) continue;
          BCCSKEL_ASSIGN_OR_RETURN(std::vector<VolumeRow> rows,
                                   store.FindVolumesOf(tenant, digest));
          for (VolumeRow& row : rows) {
            if (!blobs_.HasBlob(row.tenant, row.blob_digest, row.size_bytes)) continue;
            row.used = Now();
            BCCSKEL_RETURN_IF_ERROR(store.PutVolume(row));
            found.push_back(InfoOf(row));
          }
        }
        return found;
      },
      std::move(done));
}

void DurableLedger::GetVolume(const std::string& tenant, const std::string& volume,
                              Done<VolumeInfo> done) {
  Read<VolumeInfo>(
      [this, tenant, volume](JobStore& store) -> absl::StatusOr<VolumeInfo> {
        BCCSKEL_ASSIGN_OR_RETURN(const VolumeRow row, FindVolumeRow(store, tenant, volume));
        return InfoOf(row);
      },
      std::move(done));
}

void DurableLedger::DeleteVolume(const std::string& tenant, const std::string& volume,
                                 DoneStatus done) {
  Erase(
      [this, tenant, volume](JobStore& store, Erased& erased) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(const VolumeRow row, FindVolumeRow(store, tenant, volume));
        BCCSKEL_ASSIGN_OR_RETURN(const auto user, store.UserOfVolume(tenant, volume));
        if (!user.has_value()) return EraseVolume(store, row, erased);
        return CallError(Reason::kVolumeInUse,
                         absl::StrCat(*user, " still needs ", volume, ": cancel it first"),
                         {.key = "job", .value = *user});
      },
      Track(std::move(done)));
}

absl::Status DurableLedger::EraseVolume(JobStore& store, const VolumeRow& row, Erased& erased) {
  erased.traces = Erased::Traces::kErase;
  erased.blobs.push_back(row);  // unless another volume has the same bytes: seen at the end
  return store.DeleteVolume(row.tenant, row.name);
}

}  // namespace bccskel::server
