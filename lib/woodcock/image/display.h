// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "woodcock/image/chromaticities.h"

namespace woodcock::image {

/// How scene-linear light becomes a picture. Names are those of the config, in any case; empty: its
/// default.
struct DisplaySettings {
    std::string display, view;
    std::string look;     ///< instead of the view's own looks; "none": no look at all
    double exposure = 0;  ///< stops, applied in scene-linear before anything else
};

/// Scene-linear RGBA to display values; cheap to copy, may be used from many threads.
class DisplayTransform {
public:
    /// In place, four floats a pixel; alpha passes through. RGB must not be multiplied by alpha.
    void apply(std::span<float> rgba) const;

private:
    friend class ColorConfig;
    struct Processor;
    explicit DisplayTransform(std::shared_ptr<const Processor> processor);
    std::shared_ptr<const Processor> processor_;
};

/// An OpenColorIO configuration.
class ColorConfig {
public:
    /// `file`, or the one that $OCIO names, or the one that Woodcock ships (data/ocio). Throws
    /// Error{Input} on one that cannot be used.
    explicit ColorConfig(const std::filesystem::path& file = {});

    /// The files of the configuration: the config file, if there is one, and its look-up tables.
    const std::vector<std::filesystem::path>& files() const;

    /// A note for the user, such as that some views need a newer OpenColorIO; may be empty.
    const std::string& note() const;

    /// The chromaticities of its role scene_linear, where its name tells them: Rec.709, Rec.2020,
    /// ACEScg, ACES2065-1.
    std::optional<Chromaticities> chromaticities() const;
    /// The name of that space by the Color Interop Forum, as the config says it, or by its
    /// chromaticities; empty where neither tells.
    std::string interopId() const;

    /// Throws Error{Usage} on names that the config does not have, and lists those that it has.
    DisplayTransform displayTransform(const DisplaySettings& settings) const;

    /// Turns colours of the named space, three floats each, into scene_linear in place. Throws
    /// Error{Input} on names that the config does not have, and lists those that it has.
    void toSceneLinear(std::span<float> rgb, const std::string& space) const;
    /// The config's name of the space of ordinary pictures (sRGB curve, Rec.709 primaries); empty
    /// where the config has none of its usual names.
    std::string pictureSpace() const;

    /// The views of a display, an empty name meaning the default one; Error{Usage} as above.
    std::vector<std::string> views(const std::string& display = {}) const;

private:
    struct Impl;
    static std::shared_ptr<const Impl> load(const std::filesystem::path& file);
    std::shared_ptr<const Impl> impl_;
};

}  // namespace woodcock::image
