// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "woodcock/base/nearest_name.h"
#include "woodcock/base/printable.h"
#include "woodcock/convert/formats/dense_formats.h"
#include "woodcock/convert/formats/number_text.h"
#include "woodcock/convert/formats/source_bytes.h"

namespace woodcock::convert {

namespace {

/// Words, quoted strings (with their quotes) and brackets of a scene, comments left out.
class PbrtTokens {
public:
    PbrtTokens(std::string_view text, std::filesystem::path file)
        : text_(text), file_(std::move(file)) {}

    /// Empty at the end.
    std::string_view next() {
        const std::string_view token = peek();
        at_ = tokenEnd_;
        return token;
    }

    std::string_view peek() {
        skipSpace();
        const std::size_t begin = at_;
        if (begin == text_.size()) {
            tokenEnd_ = begin;
            return {};
        }
        if (text_[begin] == '"') {
            const std::size_t end = text_.find('"', begin + 1);
            if (end == text_.npos) throw error("a string that is not closed");
            tokenEnd_ = end + 1;
        } else if (text_[begin] == '[' || text_[begin] == ']') {
            tokenEnd_ = begin + 1;
        } else {
            tokenEnd_ = std::min(text_.find_first_of(" \t\r\n\"[]#", begin), text_.size());
        }
        return text_.substr(begin, tokenEnd_ - begin);
    }

    Error error(const std::string& found) const {
        const auto line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at_), '\n');
        return inputError("{}:{}: {}", file_.string(), line, found);
    }

private:
    void skipSpace() {
        while (true) {
            at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
            if (at_ == text_.size() || text_[at_] != '#') return;
            at_ = std::min(text_.find('\n', at_), text_.size());
        }
    }

    std::string_view text_;
    std::filesystem::path file_;
    std::size_t at_ = 0, tokenEnd_ = 0;
};

struct PbrtParameter {
    std::string type, name;
    std::vector<float> numbers;
    std::string text;
};

struct PbrtMedium {
    std::string name;
    std::vector<PbrtParameter> parameters;

    const PbrtParameter* find(std::string_view wanted) const {
        for (const PbrtParameter& p : parameters)
            if (p.name == wanted) return &p;
        return nullptr;
    }
    std::string type() const {
        const PbrtParameter* p = find("type");
        return p ? p->text : "";
    }
};

std::string unquoted(std::string_view token) {
    return token.size() >= 2 ? std::string(token.substr(1, token.size() - 2)) : std::string();
}

bool isQuoted(std::string_view token) { return token.starts_with('"'); }

void readValue(PbrtTokens& tokens, std::string_view token, PbrtParameter& parameter) {
    if (isQuoted(token)) {
        parameter.text = unquoted(token);
    } else if (token == "true" || token == "false") {
        parameter.text = token;
    } else if (const auto number = parseDouble(token)) {
        parameter.numbers.push_back(static_cast<float>(*number));
    } else {
        throw tokens.error(fmt::format("'{}' where parameter '{}' must have a number, or ]",
                                       printable(token.substr(0, 40)), parameter.name));
    }
}

PbrtParameter readParameter(PbrtTokens& tokens) {
    PbrtParameter parameter;
    const std::string declared = unquoted(tokens.next());
    const std::size_t space = declared.find_first_of(" \t");
    const std::size_t name = declared.find_first_not_of(" \t", space);
    if (space == declared.npos || name == declared.npos)
        throw tokens.error(
            fmt::format("\"{}\" where a type and a name must stand, such as "
                        "\"float density\"",
                        printable(declared.substr(0, 40))));
    parameter.type = declared.substr(0, space);
    parameter.name = declared.substr(name);
    std::string_view token = tokens.next();
    if (token != "[") {
        if (token.empty()) throw tokens.error("the end of the file within a parameter");
        readValue(tokens, token, parameter);
        return parameter;
    }
    while ((token = tokens.next()) != "]") {
        if (token.empty())
            throw tokens.error(fmt::format("the end of the file among the values of '{}', after {}",
                                           parameter.name, parameter.numbers.size()));
        readValue(tokens, token, parameter);
    }
    return parameter;
}

struct PbrtScene {
    std::vector<PbrtMedium> media;
    std::set<std::string> transforms, includes;  ///< directives met, the files included
};

PbrtScene readScene(PbrtTokens& tokens) {
    static const std::set<std::string_view> transforms{
        "Translate", "Scale",           "Rotate",           "LookAt",
        "Transform", "ConcatTransform", "CoordSysTransform"};
    PbrtScene scene;
    while (!tokens.peek().empty()) {
        const std::string directive(tokens.next());
        if (transforms.contains(directive)) scene.transforms.insert(directive);
        if (directive == "Include" || directive == "Import")
            scene.includes.insert(unquoted(tokens.peek()));
        if (directive != "MakeNamedMedium") continue;
        PbrtMedium medium;
        if (!isQuoted(tokens.peek())) throw tokens.error("MakeNamedMedium without a name");
        medium.name = unquoted(tokens.next());
        while (isQuoted(tokens.peek())) medium.parameters.push_back(readParameter(tokens));
        scene.media.push_back(std::move(medium));
    }
    return scene;
}

bool isGrid(const PbrtMedium& medium) {
    const std::string type = medium.type();
    return type == "uniformgrid" || type == "rgbgrid" || type == "heterogeneous";
}

PbrtMedium chooseMedium(PbrtScene& scene, const std::optional<std::string>& wanted,
                        const std::filesystem::path& file) {
    std::vector<std::string> names;
    std::vector<PbrtMedium*> grids;
    for (PbrtMedium& medium : scene.media) {
        if (!isGrid(medium)) continue;
        names.push_back(medium.name);
        grids.push_back(&medium);
        if (wanted && medium.name == *wanted) return std::move(medium);
    }
    if (wanted)
        throw inputError("{} has no grid medium '{}'{}", file.string(), *wanted,
                         suggestName(*wanted, "there", names));
    if (grids.size() == 1) return std::move(*grids.front());
    if (grids.size() > 1)
        throw inputError("{} has several grid media; choose one by --grid: {}", file.string(),
                         joinNames(names));
    std::string found;
    for (const PbrtMedium& medium : scene.media)
        found += fmt::format("; medium '{}' is of type '{}'", medium.name, medium.type());
    for (const std::string& include : scene.includes)
        found += fmt::format("; it includes '{}', which may have one", include);
    throw inputError("{} has no MakeNamedMedium of type uniformgrid, rgbgrid or heterogeneous{}",
                     file.string(), printable(found));
}

std::int64_t countOf(const PbrtMedium& medium, const char* name,
                     const std::filesystem::path& file) {
    const PbrtParameter* p = medium.find(name);
    if (!p) return 1;
    if (p->numbers.size() != 1 || !(p->numbers[0] >= 1) ||
        p->numbers[0] > static_cast<float>(mostVoxelsOfSide) ||
        p->numbers[0] != std::floor(p->numbers[0]))
        throw inputError("{}: '{}' of medium '{}' is not a whole number from 1 to {}",
                         file.string(), name, medium.name, mostVoxelsOfSide);
    return static_cast<std::int64_t>(p->numbers[0]);
}

Vec3d pointOf(const PbrtMedium& medium, const char* name, double usual,
              const std::filesystem::path& file) {
    const PbrtParameter* p = medium.find(name);
    if (!p) return {usual, usual, usual};
    if (p->numbers.size() != 3)
        throw inputError("{}: '{}' of medium '{}' has {} numbers instead of 3", file.string(), name,
                         medium.name, p->numbers.size());
    Vec3d v;
    for (std::size_t i = 0; i < 3; ++i) v[static_cast<int>(i)] = static_cast<double>(p->numbers[i]);
    return v;
}

/// Dims and transform, which all grids of a medium share.
DenseVolume frameOf(const PbrtMedium& medium, const std::filesystem::path& file) {
    DenseVolume frame;
    frame.dims = {countOf(medium, "nx", file), countOf(medium, "ny", file),
                  countOf(medium, "nz", file)};
    requireDims(frame, file);
    const Vec3d a = pointOf(medium, "p0", 0, file), b = pointOf(medium, "p1", 1, file);
    const Vec3d lower = min(a, b), upper = max(a, b);
    Vec3d voxel;
    for (int i = 0; i < 3; ++i)
        voxel[i] = (upper[i] - lower[i]) / static_cast<double>(frame.dims[std::size_t(i)]);
    if (!isFinite(lower) || !isFinite(upper) || !(voxel.x > 0 && voxel.y > 0 && voxel.z > 0))
        throw inputError("{}: the box of medium '{}' from p0 to p1 is empty or not finite",
                         file.string(), medium.name);
    frame.worldFromIndex = Affine3d::translate(lower + voxel * 0.5) * Affine3d::scale(voxel);
    frame.placed = true;
    return frame;
}

/// A colour that is not a grid may have as many numbers as a tiny grid.
bool maySample(const PbrtParameter& parameter) {
    static const std::set<std::string_view> names{"density", "temperature", "Lescale", "LeScale",
                                                  "sigma_a", "sigma_s",     "Le"};
    return names.contains(parameter.name) && (parameter.type == "float" || parameter.type == "rgb");
}

}  // namespace

std::vector<DenseVolume> readPbrtGrids(const std::filesystem::path& path,
                                       const std::optional<std::string>& wanted) {
    grid::FileBytes file(path, "a pbrt scene");
    requireMemory(2 * static_cast<double>(file.size()), path.string());
    file.loadAll();
    const std::span<const char> text = file.loaded(0, file.size());
    PbrtTokens tokens({text.data(), text.size()}, path);
    PbrtScene scene = readScene(tokens);
    PbrtMedium medium = chooseMedium(scene, wanted, path);
    const DenseVolume frame = frameOf(medium, path);
    std::vector<DenseVolume> volumes;
    for (PbrtParameter& parameter : medium.parameters) {
        if (!maySample(parameter)) continue;
        DenseVolume volume = frame;
        volume.name = parameter.name;
        volume.channels = parameter.type == "rgb" ? 3 : 1;
        const std::uint64_t needed = volume.voxels() * static_cast<unsigned>(volume.channels);
        const bool single = parameter.numbers.size() == static_cast<unsigned>(volume.channels);
        // A single value is a factor of the medium, unless it is the medium's density.
        if (single && needed != parameter.numbers.size() && parameter.name != "density") continue;
        if (medium.type() != "rgbgrid" && parameter.type == "rgb" && parameter.name != "density" &&
            single)
            continue;
        if (parameter.numbers.size() != needed)
            throw inputError("{}: '{}' of medium '{}' has {} numbers; nx x ny x nz{} = {}",
                             path.string(), parameter.name, medium.name, parameter.numbers.size(),
                             volume.channels == 3 ? " x 3" : "", needed);
        volume.setStridesXFirst();
        auto numbers = std::make_shared<std::vector<float>>(std::move(parameter.numbers));
        volume.samples = reinterpret_cast<const char*>(numbers->data());
        volume.owner = std::move(numbers);
        volumes.push_back(std::move(volume));
    }
    if (volumes.empty())
        throw inputError("{}: medium '{}' has no values: no \"float density\" among its parameters",
                         path.string(), medium.name);
    if (!scene.transforms.empty())
        volumes.front().notes.push_back(fmt::format(
            "{}: the scene's transforms ({}) are not applied: the grid lies in the box from p0 to "
            "p1",
            path.string(),
            joinNames(std::vector<std::string>(scene.transforms.begin(), scene.transforms.end()))));
    return volumes;
}

}  // namespace woodcock::convert
