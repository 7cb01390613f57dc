#include "client/cli/label_files.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "client/cli/load_object.h"
#include "client/export/label_paths.h"
#include "client/export/skeleton_file.h"
#include "client/view/render/subject_picture.h"
#include "core/exec/status_macros.h"
#include "core/labels/convert_label.h"

namespace bccskel::cli {
namespace {

// Paths with and without a place for the label's number.
std::vector<std::string> PathsOf(const std::vector<std::string>& paths, bool for_each_label) {
  std::vector<std::string> chosen;
  std::ranges::copy_if(paths, std::back_inserter(chosen), [&](const std::string& path) {
    return exporting::IsForEachLabel(path) == for_each_label;
  });
  return chosen;
}

}  // namespace

LabelFiles::LabelFiles(const LabelsArguments& arguments, const CollectedLabels& labels, int threads,
                       std::stop_token stop)
    : labels_(labels.objects),
      mask_(arguments.image.mask),
      title_(FileName(arguments.input)),
      root_(arguments.root),
      world_(WorldOf(labels.info)),
      swc_(arguments.swc),
      paths_of_each_(PathsOf(arguments.outputs, true)),
      paths_of_all_(PathsOf(arguments.outputs, false)),
      each_shows_object_(std::ranges::any_of(
          paths_of_each_, [](const std::string& path) { return exporting::ShowsObject(path); })),
      all_(paths_of_all_, root_, world_),
      writers_(each_shows_object_ ? static_cast<size_t>(threads) : FileWriters::kMostWriters) {
  context_.stop = std::move(stop);
}

absl::Status LabelFiles::Add(LabelSkeleton&& skeleton) {
  ++count_;
  if (!paths_of_all_.empty()) {
    all_.Add(skeleton.label, skeleton.voxels, skeleton.result, context_.stop);
  }
  if (paths_of_each_.empty()) return absl::OkStatus();
  const auto kept = std::make_shared<const LabelSkeleton>(std::move(skeleton));
  return writers_.Add([this, kept] { return WriteOwnFiles(*kept); });
}

absl::StatusOr<std::vector<WrittenFile>> LabelFiles::Finish(const ProgressBar& bar,
                                                            const exec::Context& context) && {
  bar.Begin("writing the files of the labels");
  BCCSKEL_RETURN_IF_ERROR(writers_.Finish());
  std::vector<WrittenFile> files;
  for (const std::string& path : paths_of_each_) {
    files.push_back({path, std::to_string(count_) + (count_ == 1 ? " file" : " files")});
  }
  if (all_.ShowsObjects()) {
    bar.Begin("making the surfaces of the labels");
    const auto object = [this](size_t n) { return ObjectOf(labels_.objects[n]); };
    BCCSKEL_RETURN_IF_ERROR(all_.AddObjects(object, context));
  }
  for (const std::string& path : paths_of_all_) {
    bar.Begin("writing", path);
    BCCSKEL_ASSIGN_OR_RETURN(
        std::string note,
        exporting::WriteLabeledFile(path, all_, {title_, context, view::DrawSubject}));
    files.push_back({path, std::move(note)});
  }
  return files;
}

absl::StatusOr<std::shared_ptr<const Volume>> LabelFiles::ObjectOf(
    const LabeledObject& label) const {
  BCCSKEL_ASSIGN_OR_RETURN(ConvertedMask made, ConvertLabel(labels_.grid, label, mask_, context_));
  return std::make_shared<const Volume>(std::move(made.volume));
}

absl::Status LabelFiles::WriteOwnFiles(const LabelSkeleton& skeleton) const {
  auto object = std::make_shared<const Volume>();
  if (each_shows_object_) {
    BCCSKEL_ASSIGN_OR_RETURN(object,
                             ObjectOf(*std::ranges::lower_bound(labels_.objects, skeleton.label, {},
                                                                &LabeledObject::label)));
  }
  const exporting::Subject subject = {.result = skeleton.result,
                                      .object = *object,
                                      .title = title_ + ", label " + std::to_string(skeleton.label),
                                      .context = context_,
                                      .root = root_,
                                      .world = world_,
                                      .swc = swc_,
                                      .draw = view::DrawSubject};
  for (const std::string& path : paths_of_each_) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::string own, exporting::MakePathFor(path, skeleton.label));
    BCCSKEL_RETURN_IF_ERROR(exporting::WriteSkeletonFile(own, subject).status());
  }
  return absl::OkStatus();
}

}  // namespace bccskel::cli
