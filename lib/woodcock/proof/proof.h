// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "woodcock/proof/support/temp_dir.h"

/// The renderer held against what theory knows: run by the unit tests, and by users on their own
/// machine and build (`woodcock verify`).
namespace woodcock::proof {

enum class Kind { ClosedForm, Slab, Surface, Property, Sampling, Extreme };
inline constexpr Kind kinds[]{Kind::ClosedForm, Kind::Slab,     Kind::Surface,
                              Kind::Property,   Kind::Sampling, Kind::Extreme};
const char* nameOf(Kind kind);

/// Imprecise: agrees, but with an error so large that agreement means little.
enum class Verdict { Pass, Fail, Imprecise };
const char* nameOf(Verdict verdict);

/// One number that theory knows, and what was measured.
struct Case {
    Kind kind{};
    std::string name;
    double expected = 0;
    double measured = 0;
    double standardError = 0;  ///< of `measured`; 0 where nothing is random
    double largestError = 0;   ///< a standard error above this makes the case imprecise
    /// How far `expected` itself may be off: rounding, or a discretisation that `note` names.
    double allowance = 0;
    std::string note{};
    /// Cases of the same curve are drawn together, `expected` as a line over `x`.
    std::string curve{}, xName{};
    double x = 0;

    /// Standard errors by which the difference exceeds the allowance; infinite where nothing is
    /// random or the measurement is not finite.
    double z() const;
    Verdict verdict() const;
};

/// |z| above this fails: by chance once in 16000 cases.
inline constexpr double largestZ = 4;

struct Options {
    bool full = false;      ///< three digits and more; else in less than a minute
    bool adaptive = false;  ///< pictures are sampled adaptively, as the quality `final` does
    std::uint64_t seed = 1;
    std::vector<std::filesystem::path> volumes;  ///< to hold properties of any VDB against
    /// Asked now and then while a check runs; where it says true, the check ends early.
    std::function<bool()> stop{};
};

/// Ends a check that was asked to stop.
struct Stopped {};

/// Where checks work: what was asked, a directory for files, and the cases so far.
class Lab {
public:
    explicit Lab(const Options& options) : options_(options) {}

    bool full() const { return options_.full; }
    const std::vector<std::filesystem::path>& volumes() const { return options_.volumes; }
    /// Samples, paths or sizes for the asked effort.
    int pick(int quick, int full) const { return options_.full ? full : quick; }
    double pick(double quick, double full) const { return options_.full ? full : quick; }
    /// Of its own for each name, so that no two cases share random numbers. May throw Stopped.
    std::uint64_t seed(const std::string& name) const;
    std::filesystem::path file(const std::string& name) const { return directory_ / name; }
    const std::filesystem::path& directory() const { return directory_.path(); }

    /// May throw Stopped.
    void add(Case c);
    std::vector<Case> takeCases() { return std::move(cases_); }

private:
    void stopIfAsked() const;

    Options options_;
    test::TempDir directory_;
    std::vector<Case> cases_;
};

/// Adds the cases of one subject to the lab; it sets all but their kind.
struct Check {
    Kind kind;
    const char* name;
    std::function<void(Lab&)> run;
};

/// All, in the order of kinds. A check that throws becomes a failing case with the message as note.
const std::vector<Check>& checks();

/// Runs one check; one that was stopped has the cases that it came to.
std::vector<Case> run(const Check& check, const Options& options);

}  // namespace woodcock::proof
