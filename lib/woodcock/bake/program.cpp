// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/program.h"

#include "woodcock/base/error.h"

namespace woodcock::bake {

Program::Program(const Graph& graph, std::span<const int> roots) {
    stepOf_.emplace_back(graph.entries.size(), -1);
    for (const int root : roots) roots_.push_back(add(graph, root, 0));
    stepOf_.clear();
    for (const int root : roots_) {
        std::vector<char>& need = need_.emplace_back(steps_.size(), char{0});
        need[static_cast<std::size_t>(root)] = 1;
        for (std::size_t i = steps_.size(); i-- > 0;) {
            if (!need[i]) continue;
            for (const int input : steps_[i].inputs) need[static_cast<std::size_t>(input)] = 1;
            // A step at moved points needs the move.
            for (std::size_t j = 0; j < i && steps_[i].domain > 0; ++j)
                if (steps_[j].newDomain == steps_[i].domain) need[j] = 1;
        }
    }
}

int Program::add(const Graph& graph, int entry, int domain) {
    const auto d = static_cast<std::size_t>(domain), e = static_cast<std::size_t>(entry);
    if (stepOf_[d][e] >= 0) return stepOf_[d][e];
    const Graph::Entry& node = graph.entries[e];
    // A node at moved points is another step for each mapping, and nested mappings multiply.
    constexpr std::size_t mostSteps = 20000, mostNumbers = std::size_t{1} << 26;
    if (steps_.size() >= mostSteps || stepOf_.size() * graph.entries.size() > mostNumbers)
        throw inputError(
            "{}: the recipe takes more than {} steps for each point; a node counts once for each "
            "set of moved points at which it is evaluated",
            node.place, mostSteps);
    if (node.stage) throw inputError("{}: needs grids, which exist only while baking", node.place);
    Step step{.entry = &node, .domain = domain};
    for (const int input : node.inputs) step.inputs.push_back(add(graph, input, domain));
    step.result = columns_;
    columns_ += node.mapping ? 3 : node.channels;
    if (node.mapping) step.newDomain = static_cast<int>(domainColumn_.size());
    const int newDomain = step.newDomain, column = step.result;
    steps_.push_back(std::move(step));
    int answer = static_cast<int>(steps_.size()) - 1;
    if (node.mapping) {
        domainColumn_.push_back(column);
        stepOf_.emplace_back(graph.entries.size(), -1);
        answer = add(graph, node.mapped, newDomain);  // which stands for the mapping's own values
    }
    stepOf_[d][e] = answer;
    return answer;
}

Points Program::pointsOf(const Points& outer, const Workspace& work, int domain) const {
    if (domain == 0) return outer;
    Points points{.count = outer.count, .box = work.boxes[static_cast<std::size_t>(domain)]};
    const auto column = static_cast<std::size_t>(domainColumn_[static_cast<std::size_t>(domain)]);
    for (std::size_t c = 0; c < 3; ++c)
        points.at[c] = work.numbers.data() + (column + c) * mostPoints;
    return points;
}

std::vector<Values> Program::evaluate(const Points& points, Workspace& work,
                                      std::span<const char> wanted) const {
    work.numbers.resize(static_cast<std::size_t>(columns_) * mostPoints);
    work.boxes.resize(domainColumn_.size());
    const auto columnOf = [&](int column) {
        return work.numbers.data() + static_cast<std::size_t>(column) * mostPoints;
    };
    const auto valuesOf = [&](int index) {
        const Step& step = steps_[static_cast<std::size_t>(index)];
        Values values;
        for (int c = 0; c < 3; ++c)
            values.channel[static_cast<std::size_t>(c)] =
                columnOf(step.result + (step.entry->channels == 3 ? c : 0));
        return values;
    };
    std::vector<Values> inputs;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        bool needed = wanted.empty();
        for (std::size_t r = 0; r < wanted.size(); ++r) needed |= wanted[r] && need_[r][i];
        if (!needed) continue;
        const Step& step = steps_[i];
        inputs.clear();
        for (const int input : step.inputs) inputs.push_back(valuesOf(input));
        std::array<double*, 3> out{};
        for (int c = 0; c < 3; ++c) out[static_cast<std::size_t>(c)] = columnOf(step.result + c);
        const Points at = pointsOf(points, work, step.domain);
        if (!step.entry->mapping) {
            step.entry->node->evaluate(
                at, inputs, {out.data(), static_cast<std::size_t>(step.entry->channels)});
            continue;
        }
        step.entry->mapping->move(at, inputs, out);
        Box3d& box = work.boxes[static_cast<std::size_t>(step.newDomain)] = Box3d();
        for (std::size_t p = 0; p < at.count; ++p) box.add(Vec3d{out[0][p], out[1][p], out[2][p]});
    }
    std::vector<Values> results;
    for (const int root : roots_) results.push_back(valuesOf(root));
    return results;
}

std::vector<Bounds> Program::bound(const Box3d& box, Workspace& work) const {
    work.boxes.assign(domainColumn_.size(), box);
    work.bounds.resize(steps_.size());
    std::vector<Bounds> inputs;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const Step& step = steps_[i];
        inputs.clear();
        for (const int input : step.inputs)
            inputs.push_back(work.bounds[static_cast<std::size_t>(input)]);
        const Box3d& at = work.boxes[static_cast<std::size_t>(step.domain)];
        if (step.entry->mapping)
            work.boxes[static_cast<std::size_t>(step.newDomain)] =
                step.entry->mapping->moveBox(at, inputs);
        else
            work.bounds[i] = step.entry->node->bound(at, inputs);
    }
    std::vector<Bounds> results;
    for (const int root : roots_) results.push_back(work.bounds[static_cast<std::size_t>(root)]);
    return results;
}

}  // namespace woodcock::bake
