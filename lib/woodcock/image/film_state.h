// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "woodcock/image/film.h"

namespace woodcock {
class Error;
}

namespace woodcock::image {

// Films in EXR files, exact to the last bit, so that a render can go on or be merged.
//
// The sums are a part of the file by themselves, "woodcock.sums", behind the picture: what shows
// images shows the first part. Each number of a plane is two channels of unsigned integers, as EXR
// has no doubles: "radiance.0.hi" and "radiance.0.lo" are the upper and the lower 32 bits of the
// first number of plane "radiance", a double (IEEE 754) or a count. Numbers that are zero
// everywhere are left out. Attributes of the part tell what the numbers are of.

/// Texts about the numbers, by name; attribute "woodcock/NAME" has each.
using StateFacts = std::map<std::string, std::string>;

/// What is kept of a film.
struct FilmState {
    StateFacts facts;
    int width = 0, height = 0;             ///< of the whole image
    Film::Window window;                   ///< of the numbers
    std::vector<Film::ConstPlane> planes;  ///< of the film, and whatever else its pixels have
};

/// Writes the EXR file `picture`, whose parts are flat, with `state` behind its own parts. Whole or
/// not at all; throws Error{Failure}.
void writeWithState(const std::filesystem::path& file, std::span<const unsigned char> picture,
                    const FilmState& state);

/// The name of the part with the sums, which is not to be looked at.
extern const char* const stateName;

/// A film's state in a file. The file may be damaged or come from anywhere.
class StateFile {
public:
    /// Reads what the header tells. `what` names the kind of file in messages, such as
    /// "checkpoint". Throws Error{Input}, also where the file keeps no sums.
    StateFile(const std::filesystem::path& file, std::string_view what);

    const std::filesystem::path& file() const { return file_; }
    int width() const { return width_; }
    int height() const { return height_; }
    Film::Window window() const { return window_; }
    const std::vector<std::string>& planes() const { return planes_; }  ///< their names, in order

    /// Throws Error{Input} where there is no such fact.
    const std::string& fact(const std::string& name) const;
    bool has(const std::string& fact) const { return facts_.contains(fact); }
    /// Throws Error{Input} on anything but a whole number in the range.
    std::int64_t count(const std::string& fact, std::int64_t lowest, std::int64_t highest) const;
    double number(const std::string& fact) const;  ///< likewise; finite
    /// So many, between commas: of int, std::uint64_t or float. Throws likewise.
    template <typename Number>
    std::vector<Number> numbers(const std::string& fact, std::size_t many) const;

    /// Fills `planes`, which must be those of the file, in its order, and of its window. Throws
    /// Error{Input} where numbers are not those that were written.
    void read(std::span<const Film::Plane> planes) const;

    /// "cannot read checkpoint 'a.exr': <reason>"
    Error unreadable(const std::string& reason) const;

private:
    std::filesystem::path file_;
    std::string what_;
    int part_ = 0, width_ = 0, height_ = 0;
    Film::Window window_;
    StateFacts facts_;
    std::vector<std::string> planes_;
};

}  // namespace woodcock::image
