#include "core/ranks/checkpoints.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/digest/crc32c.h"
#include "core/exec/status_macros.h"
#include "core/ranks/agreement.h"
#include "core/ranks/packing.h"

namespace bccskel::ranks {
namespace {

constexpr char kMarkName[] = "checkpoint";
constexpr uint32_t kVersion = 1;

std::string PartName(int32_t shells, int rank, int ranks) {
  return absl::StrFormat("shell-%d-part-%d-of-%d", shells, rank + 1, ranks);
}

uint64_t Mixed(uint64_t a, uint64_t b) {
  uint64_t hash = (a ^ b * 0x9e3779b97f4a7c15) * 0xbf58476d1ce4e5b9;
  return hash ^ hash >> 31;
}

// A sum, so that it does not depend on how the bricks are distributed.
uint64_t HashOf(const Volume& local, exec::Share own) {
  uint64_t sum = 0;
  for (size_t n = own.begin; n < own.end; ++n) {
    uint64_t hash = local.keys()[n].value();
    for (const uint64_t word : local.bricks()[n].words) hash = Mixed(hash, word);
    sum += hash;
  }
  return sum;
}

uint64_t HashOf(DistanceKind distance, const ThinningOptions& thinning) {
  Bytes bytes;
  Pack(distance, bytes);
  Pack(thinning.method, bytes);
  Pack(thinning.kind, bytes);
  Pack(thinning.stubble, bytes);
  Pack(thinning.shell_width, bytes);
  Pack(thinning.last_shell, bytes);
  Pack(std::span<const LatticePoint>(thinning.keep), bytes);
  return Crc32c(bytes);
}

// Appends a checksum.
Bytes Sealed(Bytes bytes) {
  Pack(Crc32c(bytes), bytes);
  return bytes;
}
absl::StatusOr<Bytes> Unsealed(const std::string& name, Bytes bytes) {
  constexpr size_t kSeal = sizeof(uint32_t);
  if (bytes.size() >= kSeal) {
    const size_t size = bytes.size() - kSeal;
    uint32_t sum = 0;
    std::memcpy(&sum, bytes.data() + size, kSeal);
    bytes.resize(size);
    if (Crc32c(bytes) == sum) return bytes;
  }
  return absl::FailedPreconditionError("checkpoint: " + name +
                                       " is damaged; start again without --resume");
}

}  // namespace

Checkpoints::Checkpoints(Exchange& exchange, const RankBricks& bricks,
                         const CheckpointOptions& options, DistanceKind distance,
                         const ThinningOptions& thinning)
    : exchange_(exchange), bricks_(bricks), options_(options) {
  if (!wanted()) return;
  job_ = HashOf(bricks.local, bricks.own);
  exchange_.Sum({&job_, 1});
  job_ = Mixed(job_, HashOf(distance, thinning));
}

absl::StatusOr<Checkpoints::Mark> Checkpoints::ReadMark() {
  BCCSKEL_ASSIGN_OR_RETURN(Bytes sealed, options_.folder->Read(kMarkName));
  BCCSKEL_ASSIGN_OR_RETURN(const Bytes bytes, Unsealed(kMarkName, std::move(sealed)));
  Unpacker from(bytes);
  const auto version = from.Take<uint32_t>();
  const auto mark = from.Take<Mark>();
  if (version == kVersion && mark.job == job_) return mark;
  return absl::FailedPreconditionError(
      "checkpoint: the one in the folder belongs to another object or other options; name another "
      "folder, or omit --resume to replace it");
}

// Each rank reads a share of the parts.
absl::StatusOr<std::vector<Bytes>> Checkpoints::ReadParts(const Mark& mark) {
  std::vector<Bytes> parts;
  for (int part = exchange_.rank(); part < mark.ranks; part += exchange_.size()) {
    const std::string name = PartName(mark.shells, part, mark.ranks);
    BCCSKEL_ASSIGN_OR_RETURN(Bytes sealed, options_.folder->Read(name));
    BCCSKEL_ASSIGN_OR_RETURN(parts.emplace_back(), Unsealed(name, std::move(sealed)));
  }
  return parts;
}

absl::StatusOr<ShellsDone> Checkpoints::Resume(std::vector<BrickBits>& object) {
  if (!wanted() || options_.resuming == Resuming::kNever) return ShellsDone();
  const absl::StatusOr<Mark> mark = ReadMark();
  uint64_t missing = absl::IsNotFound(mark.status()) ? 1 : 0;
  exchange_.Max({&missing, 1});
  if (missing != 0) return ShellsDone();
  BCCSKEL_RETURN_IF_ERROR(AgreeOn(exchange_, mark.status()));
  absl::StatusOr<std::vector<Bytes>> parts = ReadParts(*mark);
  BCCSKEL_RETURN_IF_ERROR(AgreeOn(exchange_, parts.status()));

  // Bricks go to their owners, births to all.
  std::vector<Bytes> out(static_cast<size_t>(exchange_.size()));
  Bytes births;
  for (const Bytes& part : *parts) {
    Unpacker from(part);
    const auto count = from.Take<uint64_t>();
    for (uint64_t n = 0; n < count; ++n) {
      const auto key = from.Take<BrickKey>();
      Bytes& to = out[static_cast<size_t>(bricks_.owners.OwnerOf(key))];
      Pack(key, to);
      Pack(from.Take<std::array<uint64_t, 8>>(), to);
    }
    Pack(std::span<const IsthmusBirth>(from.TakeRest<IsthmusBirth>()), births);
  }
  object.assign(bricks_.local.brick_count(), BrickBits());
  for (const Bytes& letter : TradeWithAll(exchange_, std::move(out))) {
    for (Unpacker from(letter); !from.done();) {
      const BrickIndex n = *bricks_.local.Find(from.Take<BrickKey>());
      object[n].words = from.Take<std::array<uint64_t, 8>>();
    }
  }
  ShareWithGhosts(exchange_, bricks_, std::span(object));
  ShellsDone done = {mark->shells, {}};
  for (const Bytes& letter :
       TradeWithAll(exchange_, std::vector<Bytes>(static_cast<size_t>(exchange_.size()), births))) {
    const std::vector<IsthmusBirth> some = Unpacker(letter).TakeRest<IsthmusBirth>();
    done.isthmuses.insert(done.isthmuses.end(), some.begin(), some.end());
  }
  last_ = *mark;
  return done;
}

Bytes Checkpoints::PartOf(const ThinningState& state,
                          const std::vector<IsthmusBirth>& isthmuses) const {
  Bytes bytes;
  uint64_t count = 0;
  Pack(count, bytes);
  for (size_t n = bricks_.own.begin; n < bricks_.own.end; ++n) {
    if (state.object[n].Empty()) continue;
    Pack(state.keys[n], bytes);
    Pack(state.object[n].words, bytes);
    ++count;
  }
  std::memcpy(bytes.data(), &count, sizeof(count));
  Pack(std::span<const IsthmusBirth>(isthmuses), bytes);
  return Sealed(std::move(bytes));
}

absl::Status Checkpoints::AfterShell(int32_t shell, const ThinningState& state,
                                     const std::vector<IsthmusBirth>& isthmuses) {
  uint64_t due = Clock::now() - written_ >= options_.interval ? 1 : 0;
  exchange_.Max({&due, 1});
  if (due == 0) return absl::OkStatus();
  const int rank = exchange_.rank(), ranks = exchange_.size();
  BCCSKEL_RETURN_IF_ERROR(AgreeOn(
      exchange_, options_.folder->Write(PartName(shell, rank, ranks), PartOf(state, isthmuses))));
  const Mark mark = {shell, ranks, job_};
  absl::Status marked;
  if (rank == 0) {
    Bytes bytes;
    Pack(kVersion, bytes);
    Pack(mark, bytes);
    marked = options_.folder->Write(kMarkName, Sealed(std::move(bytes)));
  }
  BCCSKEL_RETURN_IF_ERROR(AgreeOn(exchange_, marked));
  if (last_.has_value()) {
    for (int part = rank; part < last_->ranks; part += ranks) {
      options_.folder->Remove(PartName(last_->shells, part, last_->ranks));
    }
  }
  last_ = mark;
  written_ = Clock::now();
  return absl::OkStatus();
}

}  // namespace bccskel::ranks
