// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "woodcock/image/denoised_picture.h"
#include "woodcock/image/film.h"

namespace woodcock::denoise {

// Pictures are denoised by Open Image Denoise, which is no part of Woodcock: it is loaded where it
// is installed, while the program runs.

/// The environment variable that names the library, or a folder that holds it.
inline constexpr const char* libraryVariable = "WOODCOCK_OIDN";

/// Where the library is looked for, for help and messages; a sentence.
std::string searchText();

/// Open Image Denoise 2, loaded. Copies share it. It stays loaded until the program ends, as its
/// threads may outlive what started them.
class Denoiser {
public:
    /// The first that can be used, in the order of searchText(). Where libraryVariable is set,
    /// only what that names counts. Throws Error{Usage} where there is none, which says where it
    /// was looked for, and what is wrong with what was found.
    static Denoiser load();
    /// The same; absent where none is installed. Throws where one is, and cannot be used.
    static std::optional<Denoiser> find();

    const std::string& name() const;            ///< "Open Image Denoise 2.5.1"
    const std::filesystem::path& file() const;  ///< of the library, as it was found

    /// The film's radiance, denoised with the help of its albedo and normal, which are filtered
    /// first. The film has to keep these (KeptSums::features). `threads`: 0 for all cores; they do
    /// not change the picture. Throws Error{Failure} where the library fails.
    image::DenoisedPicture denoise(const image::Film& film, int threads = 0) const;

private:
    struct Library;
    explicit Denoiser(std::shared_ptr<const Library> library);
    static std::optional<Denoiser> search(bool needed);

    std::shared_ptr<const Library> library_;
};

/// Memory that denoising so many pixels takes beside the film, in bytes: what Woodcock holds, and
/// what Open Image Denoise 2.5 was seen to take.
double bytesToDenoise(double pixels);

}  // namespace woodcock::denoise
