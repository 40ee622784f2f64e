// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/instance_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/grid/input_file.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

constexpr std::string_view expected =
    "x y z, x y z scale, x y z scale rx ry rz, or the 12 numbers of a matrix of three rows";
constexpr size_t mostNumbers = 12;

/// One line on its way to a transform.
class Line {
public:
    Line(std::string_view text, const std::filesystem::path& file, size_t number)
        : rest_(text.substr(0, text.find('#'))), file_(file), number_(number) {}

    /// False where there is nothing but space.
    bool read() {
        while (skipSpace()) {
            if (count_ == mostNumbers)
                throw error("more than {} numbers; expected {}", mostNumbers, expected);
            readNumber();
        }
        return count_ > 0;
    }

    Affine3d transform() const {
        const auto& n = numbers_;
        const Vec3d position{n[0], n[1], n[2]};
        Affine3d map;
        switch (count_) {
            case 3:
                return Affine3d::translate(position);
            case 4:
                map = placement(position, {}, Vec3d{1, 1, 1} * n[3]);
                break;
            case 7:
                map = placement(position, {n[4], n[5], n[6]}, Vec3d{1, 1, 1} * n[3]);
                break;
            case 12:
                map = {{Vec3d{n[0], n[4], n[8]}, {n[1], n[5], n[9]}, {n[2], n[6], n[10]}},
                       {n[3], n[7], n[11]}};
                break;
            default:
                throw error("{} number{}; expected {}", count_, count_ == 1 ? "" : "s", expected);
        }
        if (const std::string flaw = flawOf(map); !flaw.empty())
            throw error("a transform that {}", flaw);
        return map;
    }

private:
    bool skipSpace() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r"), rest_.size()));
        return !rest_.empty();
    }

    void readNumber() {
        const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r"));
        const char* const end = word.data() + word.size();
        const char* const begin = word.data() + (word.front() == '+' && word.size() > 1);
        double& value = numbers_[count_];
        const auto [stop, failed] = std::from_chars(begin, end, value);
        if (failed != std::errc() || stop != end || !std::isfinite(value))
            throw error("'{}', which is no number that can be used; expected {}",
                        printable(word.substr(0, 40)), expected);
        ++count_;
        rest_.remove_prefix(word.size());
    }

    template <class... A>
    Error error(fmt::format_string<A...> message, A&&... args) const {
        return inputError("{}:{}: found {}", file_.string(), number_,
                          fmt::format(message, std::forward<A>(args)...));
    }

    std::string_view rest_;
    const std::filesystem::path& file_;
    size_t number_;
    std::array<double, mostNumbers> numbers_{};
    size_t count_ = 0;
};

}  // namespace

std::vector<Affine3d> readInstanceFile(const std::filesystem::path& file) {
    const std::string text = grid::readInput(file);
    std::vector<Affine3d> instances;
    size_t number = 0;
    for (std::string_view rest = text; !rest.empty();) {
        const size_t end = rest.find('\n');
        Line line(rest.substr(0, end), file, ++number);
        if (line.read()) instances.push_back(line.transform());
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    if (instances.empty())
        throw inputError("{} places no instance; expected lines of {}", file.string(), expected);
    return instances;
}

}  // namespace woodcock::scene
