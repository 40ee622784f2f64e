// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "woodcock/bake/node.h"

namespace woodcock::bake {

/// A graph, ready to be evaluated: each node is a step for each set of points at which it is
/// needed. Inputs come before the steps that use them. Each mapping makes a new set of points.
class Program {
public:
    /// `roots` are entries of the graph, which must outlive the program.
    Program(const Graph& graph, std::span<const int> roots);

    /// The memory for one thread's values.
    class Workspace {
        friend class Program;
        std::vector<double> numbers;
        std::vector<Box3d> boxes;
        std::vector<Bounds> bounds;
    };
    static constexpr std::size_t mostPoints = 512;

    /// Values of the roots at up to mostPoints points; valid until the workspace is used again.
    /// Only roots of `wanted` (all, if empty) are computed.
    std::vector<Values> evaluate(const Points& points, Workspace& work,
                                 std::span<const char> wanted = {}) const;
    std::vector<Bounds> bound(const Box3d& box, Workspace& work) const;

private:
    struct Step {
        const Graph::Entry* entry = nullptr;
        int domain = 0;             ///< whose points it takes
        int result = 0;             ///< first column it writes: of values, or of a domain's points
        int newDomain = -1;         ///< of a mapping
        std::vector<int> inputs{};  ///< steps
    };
    int add(const Graph& graph, int entry, int domain);
    Points pointsOf(const Points& outer, const Workspace& work, int domain) const;

    std::vector<Step> steps_;
    std::vector<int> roots_;               ///< steps
    std::vector<std::vector<char>> need_;  ///< by root: the steps it needs
    std::vector<int> domainColumn_{-1};    ///< first column of a domain's points
    int columns_ = 0;
    std::vector<std::vector<int>> stepOf_;  ///< by domain and entry, while it is built
};

}  // namespace woodcock::bake
