// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace woodcock::image {

/// The only way to open images. OpenImageIO gets only regular files of a known format, whose
/// headers claim no more than the file can hold (image_header.h).
class OpenImage {
public:
    /// `what` names the kind of file in messages: "image", "slice". Colours are not multiplied by
    /// alpha. Throws Error{Input} "cannot read image 'a.exr': ...", also for deep and volumetric
    /// pixels.
    explicit OpenImage(const std::filesystem::path& file, std::string_view what = "image");

    /// The description of the current part; it names every channel.
    const OIIO::ImageSpec& spec() const { return spec_; }
    bool isExr() const;
    /// Goes to a part; false where there is none. Throws Error{Input} as the constructor does.
    bool goTo(int part);
    /// All channels of the current part as floats: width x height x channels. Throws Error{Input}.
    void read(float* to);

    class Error unreadable(const std::string& reason) const;

private:
    void check();
    template <class Act>
    auto guarded(Act act) const;

    std::filesystem::path file_;
    std::string what_;
    std::unique_ptr<OIIO::ImageInput> input_;
    OIIO::ImageSpec spec_;
    int part_ = 0;
};

}  // namespace woodcock::image
