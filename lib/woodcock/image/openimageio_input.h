// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace woodcock {

/// The one way in for images. What OpenImageIO gets is a regular file of a known format, whose
/// header claims no more than the file can hold (image_header.h).
class OpenImage {
public:
    /// `what` names the file's part in messages: "image", "slice". Colours are not multiplied by an
    /// alpha. Throws Error{Input} "cannot read image 'a.exr': ...", of deep and volumetric pixels
    /// too.
    explicit OpenImage(const std::filesystem::path& file, std::string_view what = "image");

    /// Of the current part; it names every channel.
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

}  // namespace woodcock
