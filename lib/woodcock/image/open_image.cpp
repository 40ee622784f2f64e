// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <new>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/image/image_header.h"
#include "woodcock/image/openimageio_input.h"

namespace woodcock::image {

namespace {

/// The best ratio of a TIFF's compression, which it names.
double bestRatio(const OIIO::ImageSpec& spec) {
    const std::string packing = spec.get_string_attribute("compression");
    if (packing.empty() || packing == "none") return 1;
    if (packing == "packbits") return 64;
    if (packing == "zip") return 1032;
    if (packing == "lzw") return 4096;
    if (packing == "jpeg") return 2048;
    return 20000;  // facsimiles, of long runs of bits, and the newer packers
}

}  // namespace

template <class Act>
auto OpenImage::guarded(Act act) const {
    try {
        return act();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw failure("cannot read {} '{}': there is not enough memory for it", what_,
                      file_.string());
    } catch (const std::exception& e) {
        throw unreadable(fmt::format("it is damaged ({})", e.what()));
    }
}

OpenImage::OpenImage(const std::filesystem::path& file, std::string_view what)
    : file_(file), what_(what) {
    const RegularFile bytes(file, what);
    const std::string format = checkImageHeader(bytes, file);
    guarded([&] {
        input_ = OIIO::ImageInput::create(format);
        if (!input_)
            throw unreadable(
                fmt::format("this build's OpenImageIO reads no {} ({})", format, OIIO::geterror()));
        OIIO::ImageSpec asItIs;  // otherwise colours are multiplied by alpha
        asItIs.attribute("oiio:UnassociatedAlpha", 1);
        if (!input_->open(file.string(), spec_, asItIs)) throw unreadable(input_->geterror());
        check();
        if (format != "tiff") return;
        const auto pixelBytes = static_cast<double>(spec_.pixel_bytes(true));
        requirePlausible(bytes, spec_.width, spec_.height, pixelBytes, bestRatio(spec_));
        // The pixels of a whole tile or strip are held at once.
        if (spec_.tile_width > 0)
            requirePlausible(bytes, spec_.tile_width, spec_.tile_height, pixelBytes,
                             bestRatio(spec_));
    });
}

bool OpenImage::isExr() const { return std::string_view(input_->format_name()) == "openexr"; }

bool OpenImage::goTo(int part) {
    return guarded([&] {
        if (!input_->seek_subimage(part, 0)) {
            input_->geterror();  // no error, but the end
            return false;
        }
        spec_ = input_->spec();
        part_ = part;
        check();
        return true;
    });
}

void OpenImage::check() {
    if (spec_.deep || spec_.depth > 1 || spec_.width < 1 || spec_.height < 1 || spec_.nchannels < 1)
        throw unreadable("it does not hold a flat picture");
    // Some readers leave out names, on which OpenImageIO's own functions rely.
    while (spec_.channelnames.size() < static_cast<std::size_t>(spec_.nchannels))
        spec_.channelnames.push_back(fmt::format("channel{}", spec_.channelnames.size()));
    const double bytes =
        2.0 * sizeof(float) * static_cast<double>(spec_.width) * spec_.height * spec_.nchannels;
    if (const auto limit = static_cast<double>(memoryLimit()); bytes > limit)
        throw unreadable(fmt::format(
            "its {} x {} pixels of {} channels need {} of memory, and "
            "there are {}",
            spec_.width, spec_.height, spec_.nchannels, formatGiB(bytes), formatGiB(limit)));
}

void OpenImage::read(float* to) {
    guarded([&] {
        if (!input_->read_image(part_, 0, 0, spec_.nchannels, OIIO::TypeDesc::FLOAT, to))
            throw unreadable(input_->geterror());
    });
}

Error OpenImage::unreadable(const std::string& reason) const {
    return inputError("cannot read {} '{}': {}", what_, file_.string(),
                      reason.empty() ? "it is damaged" : reason);
}

}  // namespace woodcock::image
