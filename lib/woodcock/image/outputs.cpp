// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/outputs.h"

#include <algorithm>
#include <new>

#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/image_format.h"
#include "woodcock/image/write_cryptomatte.h"
#include "woodcock/image/write_deep.h"
#include "woodcock/image/write_display.h"

namespace woodcock::image {

Outputs::Outputs(OutputSettings settings) : settings_(std::move(settings)) {
    const auto& files = settings_.files;
    for (auto file = files.begin(); file != files.end(); ++file) {
        if (std::find(files.begin(), file, *file) != file)
            throw usageError("output '{}' is named twice", file->string());
        const bool display = imageFormat(*file) != ImageFormat::Exr;
        checkWritable(*file);
        if (display && !transform_)
            transform_ = settings_.colour.displayTransform(settings_.display);
    }
    const auto checkLayers = [&](const std::filesystem::path& file, const char* what) {
        if (file.empty()) return;
        if (imageFormat(file) != ImageFormat::Exr)
            throw usageError("{} need an EXR file; '{}' is none", what, file.string());
        if (std::find(files.begin(), files.end(), file) != files.end())
            throw usageError("'{}' is to hold both the picture and {}; give two names",
                             file.string(), what);
        checkWritable(file);
    };
    checkLayers(settings_.deepFile, "deep pixels");
    checkLayers(settings_.matteFile, "mattes");
    if (!settings_.deepFile.empty() && settings_.deepFile == settings_.matteFile)
        throw usageError("'{}' is to hold both deep pixels and mattes; give two names",
                         settings_.deepFile.string());
}

ExrSettings Outputs::exrSettings() const {
    return {settings_.half,
            settings_.layers,
            settings_.colour.chromaticities(),
            settings_.colour.interopId(),
            settings_.multipart,
            settings_.denoised};
}

double Outputs::bytesPerPixel() const {
    constexpr double displayBytes = 4 * 4 + 3 * 4 + 2 * 4;  // floats, without alpha, and the file's
    const double matteBytes =
        2.0 * sizeof(float) * 2 * matteRanks * static_cast<double>(settings_.matteLayers);
    double most = settings_.matteFile.empty() ? 0 : matteBytes;
    for (const std::filesystem::path& file : settings_.files)
        most = std::max(most, imageFormat(file) == ImageFormat::Exr
                                  ? exrBytesPerPixel(exrSettings()) + matteBytes
                                  : displayBytes);
    return most;
}

/// Returns the share of pixels of which alpha was raised; see writeDisplay().
double Outputs::write(const std::filesystem::path& file, const Film& film,
                      const RenderMetadata& metadata, const BesideFilm& beside,
                      const FilmState* state) const {
    if (file == settings_.deepFile) {
        writeDeep(file, *beside.deep, film, metadata, settings_.colour.chromaticities());
    } else if (file == settings_.matteFile) {
        writeCryptomatte(file, *beside.mattes, film, metadata);
    } else if (imageFormat(file) == ImageFormat::Exr) {
        writeExr(file, film, metadata, exrSettings(), state, ofExr(beside));
    } else {
        return writeDisplay(file, film, *transform_,
                            {settings_.withAlpha, settings_.glows, settings_.display.exposure},
                            beside.denoised);
    }
    return 0;
}

std::string Outputs::write(const Film& film, const RenderMetadata& metadata,
                           const BesideFilm& beside, const FilmState* state) const {
    std::string failures, note;
    std::vector<std::filesystem::path> files = settings_.files;
    if (beside.mattes && !settings_.matteFile.empty()) files.push_back(settings_.matteFile);
    if (beside.deep && !settings_.deepFile.empty()) files.push_back(settings_.deepFile);
    for (const std::filesystem::path& file : files) {
        try {
            const double raised = write(file, film, metadata, beside, state);
            if (raised > 0 && note.empty())
                note = fmt::format(
                    "{}: {:.2g} % of the pixels emit more light than their alpha covers, as fire "
                    "does. This format cannot add light, so their alpha is raised to their "
                    "brightest channel. An EXR keeps light and alpha as they are",
                    file.string(), 100 * raised);
        } catch (const Error& e) {
            failures += (failures.empty() ? "" : "\n") + std::string(e.what());
        } catch (const std::bad_alloc&) {
            failures += fmt::format("{}cannot write '{}': there is not enough memory to encode it",
                                    failures.empty() ? "" : "\n", file.string());
        }
    }
    if (!failures.empty()) throw failure("{}", failures);
    return note;
}

}  // namespace woodcock::image
