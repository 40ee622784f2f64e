// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/dense_file.h"
#include "woodcock/convert/formats/dense_formats.h"
#include "woodcock/convert/formats/source_bytes.h"

namespace woodcock::convert {

DenseVolume readRaw(const std::filesystem::path& file, const RawLayout& layout) {
    DenseVolume volume;
    volume.dims = layout.dims;
    volume.channels = layout.channels;
    volume.type = layout.type;
    volume.swapped = layout.bigEndian != (std::endian::native == std::endian::big);
    auto bytes = std::make_shared<grid::FileBytes>(file, "a file of numbers");
    if (layout.headerBytes > bytes->size())
        throw inputError("{}: --header gives {} bytes, and the whole file has {}", file.string(),
                         layout.headerBytes, bytes->size());
    loadSamples(volume, std::move(bytes), layout.headerBytes);
    volume.setStridesXFirst();
    return volume;
}

double writeRaw(const std::filesystem::path& file, const DenseVolume& volume,
                const DenseWriteOptions& options) {
    return writeDenseFile(file, volume, {.type = options.type.value_or(volume.type)},
                          options.progress);
}

}  // namespace woodcock::convert
