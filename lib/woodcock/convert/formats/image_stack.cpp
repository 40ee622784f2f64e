// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/dense_formats.h"
#include "woodcock/image/read_slices.h"

namespace woodcock::convert {

namespace {

DenseVolume upright(image::Slices read) {
    auto slices = std::make_shared<image::Slices>(std::move(read));
    DenseVolume volume;
    volume.dims = {slices->width, slices->height, static_cast<std::int64_t>(slices->count)};
    volume.channels = slices->channels;
    volume.setStridesXFirst();
    // Rows come from the top, and y goes up.
    volume.first = (volume.dims[1] - 1) * volume.stride[1];
    volume.stride[1] = -volume.stride[1];
    volume.samples = reinterpret_cast<const char*>(slices->values.data());
    volume.owner = std::move(slices);
    return volume;
}

}  // namespace

bool isImagePattern(const std::filesystem::path& file) { return image::hasSliceNumber(file); }

DenseVolume readImageStack(const std::filesystem::path& pattern, const WorkProgress& progress) {
    return upright(image::readSlices(pattern, progress));
}

DenseVolume readImageFiles(const std::vector<std::filesystem::path>& files,
                           const WorkProgress& progress) {
    return upright(image::readSliceFiles(files, progress));
}

DenseVolume readImagePages(const std::filesystem::path& file, const WorkProgress& progress) {
    return upright(image::readPages(file, progress));
}

}  // namespace woodcock::convert
