// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "woodcock/base/temp_dir.h"

/// Checks of the renderer against theory. The unit tests run them, and users can run them on their
/// own machine and build (`woodcock verify`).
namespace woodcock::proof {

enum class Kind { ClosedForm, Slab, Surface, Property, Sampling, Extreme };
inline constexpr Kind kinds[]{Kind::ClosedForm, Kind::Slab,     Kind::Surface,
                              Kind::Property,   Kind::Sampling, Kind::Extreme};
const char* nameOf(Kind kind);

/// Imprecise: it agrees, but its error is so large that this means little.
enum class Verdict { Pass, Fail, Imprecise };
const char* nameOf(Verdict verdict);

/// A number known by theory, and its measurement.
struct Case {
    Kind kind{};
    std::string name;
    double expected = 0;
    double measured = 0;
    double standardError = 0;  ///< of `measured`; 0 where nothing is random
    double largestError = 0;   ///< a standard error above this makes the case imprecise
    /// The possible error of `expected` itself: rounding, or a discretisation that `note` names.
    double allowance = 0;
    std::string note{};
    /// Cases of one curve are plotted together, with `expected` as a line over `x`.
    std::string curve{}, xName{};
    double x = 0;

    /// The number of standard errors by which the difference exceeds the allowance. Infinite where
    /// nothing is random, or the measurement is not finite.
    double z() const;
    Verdict verdict() const;
};

/// |z| above this fails: by chance once in 16000 cases.
inline constexpr double largestZ = 4;

struct Options {
    bool full = false;      ///< three digits and more; else in less than a minute
    bool adaptive = false;  ///< pictures are sampled adaptively, as the quality `final` does
    std::uint64_t seed = 1;
    std::vector<std::filesystem::path> volumes;  ///< of the user's, for the checks of any volume
    /// Called now and then while a check runs; if it returns true, the check ends early.
    std::function<bool()> stop{};
};

/// Thrown to end a check that was asked to stop.
struct Stopped {};

/// The workplace of checks: the options, a directory for files, and the cases so far.
class Lab {
public:
    explicit Lab(const Options& options) : options_(options) {}

    bool full() const { return options_.full; }
    const std::vector<std::filesystem::path>& volumes() const { return options_.volumes; }
    /// Samples, paths or sizes for the asked effort.
    int pick(int quick, int full) const { return options_.full ? full : quick; }
    double pick(double quick, double full) const { return options_.full ? full : quick; }
    /// A seed from the name, so that no two cases share random numbers. May throw Stopped.
    std::uint64_t seed(const std::string& name) const;
    std::filesystem::path file(const std::string& name) const { return directory_ / name; }
    const std::filesystem::path& directory() const { return directory_.path(); }

    /// May throw Stopped.
    void add(Case c);
    std::vector<Case> takeCases() { return std::move(cases_); }

private:
    void stopIfAsked() const;

    Options options_;
    TempDir directory_;
    std::vector<Case> cases_;
};

/// Adds the cases of one subject to the lab; it sets all but their kind.
struct Check {
    Kind kind;
    const char* name;
    std::function<void(Lab&)> run;
};

/// All checks, in the order of kinds. A check that throws becomes a failing case, with the message
/// as its note.
const std::vector<Check>& checks();

/// Runs one check. If it was stopped, it has the cases so far.
std::vector<Case> run(const Check& check, const Options& options);

}  // namespace woodcock::proof
