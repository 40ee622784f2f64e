// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/source_bytes.h"

#include "woodcock/base/memory.h"

namespace woodcock::convert {

namespace {

/// A hint for the user: the one number whose change would explain the file's size.
std::string hint(const DenseVolume& volume, std::uint64_t found) {
    const auto fits = [&](const Dims& dims, int channels, SampleType type) {
        return denseBytes(dims, channels, type) == found;
    };
    for (const SampleType type :
         {SampleType::F32, SampleType::U8, SampleType::U16, SampleType::F64})
        if (fits(volume.dims, volume.channels, type))
            return fmt::format("; numbers of {} byte{} ({}) would fit", sampleBytes(type),
                               sampleBytes(type) == 1 ? "" : "s",
                               type == SampleType::F32   ? "f32, u32 or i32"
                               : type == SampleType::U8  ? "u8 or i8"
                               : type == SampleType::U16 ? "f16, u16 or i16"
                                                         : "f64, u64 or i64");
    for (const int channels : {1, 2, 3, 4})
        if (fits(volume.dims, channels, volume.type))
            return fmt::format("; {} channel{} would fit", channels, channels == 1 ? "" : "s");
    for (std::size_t a = 3; a-- > 0;) {
        Dims dims = volume.dims;
        dims[a] = 1;
        const auto layer = denseBytes(dims, volume.channels, volume.type);
        if (!layer || found % *layer != 0 || found == 0) continue;
        dims[a] = static_cast<std::int64_t>(found / *layer);
        return fmt::format("; {} x {} x {} would fit", dims[0], dims[1], dims[2]);
    }
    return {};
}

}  // namespace

std::uint64_t requireDims(const DenseVolume& volume, const std::filesystem::path& file) {
    const auto bytes = denseBytes(volume.dims, volume.channels, volume.type);
    if (!bytes)
        throw inputError(
            "{}: {} x {} x {} voxels with {} channels are not a volume; each side must be from 1 "
            "to {}",
            file.string(), volume.dims[0], volume.dims[1], volume.dims[2], volume.channels,
            mostVoxelsOfSide);
    return *bytes;
}

void requireMemory(double bytes, const std::string& what) {
    const auto limit = static_cast<double>(memoryLimit());
    if (bytes > limit)
        throw inputError("{} need {} of memory, and there are {}", what, formatGiB(bytes),
                         formatGiB(limit));
}

void loadSamples(DenseVolume& volume, std::shared_ptr<grid::FileBytes> file, std::uint64_t begin) {
    const std::uint64_t needed = requireDims(volume, file->path());
    const std::uint64_t found = file->size() - std::min(begin, file->size());
    if (needed != found) {
        const std::uint64_t header = found > needed ? begin + (found - needed) : 0;
        std::string more = hint(volume, found);
        if (more.empty() && header > 0)
            more = fmt::format("; a header of {} bytes would explain it", header);
        throw inputError("{}: {} need {} bytes after byte {}, and there are {}{}",
                         file->path().string(), volume.describe(), needed, begin, found, more);
    }
    requireMemory(static_cast<double>(needed),
                  fmt::format("{}: {}", file->path().string(), volume.describe()));
    file->enter(begin, file->size(), "its values");
    file->loadAll();
    volume.samples = file->loaded(begin, file->size()).data();
    volume.owner = std::move(file);
}

}  // namespace woodcock::convert
