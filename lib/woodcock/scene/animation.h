// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <map>
#include <string>
#include <vector>

#include "woodcock/base/keyframes.h"
#include "woodcock/scene/description.h"

namespace woodcock::scene {

// A number, colour, vector, matrix or transform of a scene may be animated:
//
//     eye = { keys = [[0, [0, 1, 5]], [48, [5, 1, 0]]], interpolation = "smooth" }
//
// Readers of sections never see such a table. They read its value at a frame, in its place. What is
// kept of it in a description are AnimatedValues.

/// The description at a frame, which need not be whole: every animated value as it is there. What
/// was changed or chosen elsewhere stays. Throws Error{Input} where the values of a frame do not go
/// together; each by itself was checked at its keys.
SceneDescription atFrame(const SceneDescription& scene, double frame);

/// The frames at which animated values have keys, in order, each once.
std::vector<double> keyFrames(const SceneDescription& scene);

/// Whether a value of the table ("camera", "volume[0]") is animated.
bool isAnimated(const SceneDescription& scene, std::string_view table);

/// The curves of an animated value, at places of a tree of TOML.
class AnimatedTree {
public:
    /// Finds the curves below `root`, which keeps being changed. Throws Error{Input} on curves that
    /// are not right.
    explicit AnimatedTree(toml::table& root);
    ~AnimatedTree();

    bool empty() const { return curves_.empty(); }
    std::vector<double> frames() const;  ///< of all keys, in order
    /// Puts values in the places of curves.
    void setFrame(double frame);
    /// What a description keeps of them, once it was read at a frame.
    std::vector<AnimatedValue> valuesOf(const SceneDescription& scene) const;

private:
    struct Curve;
    struct Section;
    std::vector<Curve> curves_;
    std::vector<Section> sections_;
};

/// The lines of a section ("[camera]\n...") of the table that `values` are of, with them in it: in
/// place of what the description says at its frame.
std::string withAnimation(const std::string& section, const SceneDescription& scene,
                          std::string_view table);

}  // namespace woodcock::scene
