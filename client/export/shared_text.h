#ifndef BCCSKEL_CLIENT_EXPORT_SHARED_TEXT_H_
#define BCCSKEL_CLIENT_EXPORT_SHARED_TEXT_H_

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "client/export/text.h"
#include "core/exec/context.h"

namespace bccskel::exporting {

inline size_t SizeOf(const std::vector<std::string>& pieces) {
  size_t size = 0;
  for (const std::string& piece : pieces) size += piece.size();
  return size;
}

// Appends items 0..count-1 of a large graph, whose texts threads share. `new_writer()` makes a
// function of a text and n that writes item n; each thread has some of its own. After a stop
// request the text is incomplete, as the caller's.
template <typename NewWriter>
void AddShared(Text& text, size_t count, const exec::Context& context, NewWriter new_writer) {
  // Pieces are appended in rounds, so that their memory is used again. The first round tells how
  // long the text will be, about.
  constexpr size_t kItems = 512, kPieces = 128;
  std::vector<std::string> pieces(kPieces);
  for (size_t first = 0; first < count; first += kItems * kPieces) {
    const size_t items = std::min(kItems * kPieces, count - first);
    const absl::Status done = context.ForEachShare(items, kItems, [&](exec::Share share) {
      Text piece(context.stop);
      auto write = new_writer();
      for (size_t n = share.begin; n < share.end && !piece.stopped(); ++n) write(piece, first + n);
      pieces[share.begin / kItems] = std::move(piece).Take();
    });
    if (!done.ok()) return;
    if (first == 0) text.Reserve(text.size() + SizeOf(pieces) / items * count / 8 * 9);
    for (std::string& piece : pieces) {
      text.Add(piece);
      piece = std::string();
    }
  }
}

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SHARED_TEXT_H_
