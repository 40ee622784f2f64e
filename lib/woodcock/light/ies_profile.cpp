// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/ies_profile.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "woodcock/base/error.h"

namespace woodcock::light {

namespace {

/// The numbers of a file, one after the other.
class Numbers {
public:
    Numbers(std::string_view text, std::string_view name) : rest_(text), name_(name) {}

    template <class... A>
    Error error(fmt::format_string<A...> text, A&&... args) const {
        return inputError("{}:{}: {}", name_, line_, fmt::format(text, std::forward<A>(args)...));
    }

    /// Goes on behind the line that begins with "TILT=", and returns what stands there.
    std::string_view skipToTilt() {
        while (!rest_.empty()) {
            const std::string_view line = nextLine();
            if (line.starts_with("TILT=")) return line.substr(5);
        }
        line_ = 1;
        throw error("there is no line TILT=, so this is no photometric file of LM-63");
    }

    double number(std::string_view what) {
        skipBlanks();
        if (rest_.empty()) throw error("the file ends before {}", what);
        const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n,"));
        const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
        double value = 0;
        const auto [end, flaw] =
            std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (flaw != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
            throw error("{} is '{}', which is no number", what, word.substr(0, 40));
        rest_.remove_prefix(word.size());
        return value;
    }
    std::size_t count(std::string_view what, std::size_t least, std::size_t most = 10000) {
        const double value = number(what);
        if (!(value >= static_cast<double>(least) && value <= static_cast<double>(most) &&
              value == std::floor(value)))
            throw error("{} is {:g}; it must be a whole number from {} to {}", what, value, least,
                        most);
        return static_cast<std::size_t>(value);
    }
    double notNegative(std::string_view what) {
        const double value = number(what);
        if (value < 0) throw error("{} is {:g}, below 0", what, value);
        return value;
    }
    /// Angles in degrees, each larger than the one before.
    std::vector<double> angles(std::string_view what, std::size_t n) {
        std::vector<double> list;
        for (std::size_t i = 0; i < n; ++i) {
            list.push_back(number(fmt::format("{} {} of {}", what, i + 1, n)));
            if (i > 0 && !(list[i] > list[i - 1]))
                throw error("{} {} of {} is {:g}, not larger than the one before, {:g}", what,
                            i + 1, n, list[i], list[i - 1]);
        }
        return list;
    }
    void expectEnd() {
        skipBlanks();
        if (!rest_.empty() && rest_.front() != '\x1a' && rest_.front() != '\0')
            throw error("there is more behind the last candela: '{}'",
                        rest_.substr(0, std::min<std::size_t>(rest_.find_first_of("\r\n"), 20)));
    }

private:
    std::string_view nextLine() {
        ++line_;
        const std::size_t end = rest_.find('\n');
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
        behindLine_ = true;
        return line;
    }
    void skipBlanks() {
        if (behindLine_) ++line_, behindLine_ = false;
        while (!rest_.empty() && std::string_view(" \t\r\n,").find(rest_.front()) != rest_.npos) {
            line_ += rest_.front() == '\n';
            rest_.remove_prefix(1);
        }
    }

    std::string_view rest_, name_;
    int line_ = 0;
    bool behindLine_ = false;  // at the beginning of a line that is not counted yet
};

void skipTilt(Numbers& file) {
    file.number("the lamp's place in the luminaire");
    const std::size_t n = file.count("the number of tilt angles", 1);
    for (std::size_t i = 0; i < 2 * n; ++i) file.number("a number of the tilt table");
}

void checkVertical(const Numbers& file, const std::vector<double>& v) {
    const bool below = v.front() == 0 && (v.back() == 90 || v.back() == 180);
    const bool above = v.front() == 90 && v.back() == 180;
    if (!below && !above)
        throw file.error(
            "the vertical angles go from {:g} to {:g}; in a file of type C they go from 0 to 90, 0 "
            "to 180, or 90 to 180",
            v.front(), v.back());
}

}  // namespace

// ANSI/IES LM-63-02, sec. 5: what stands where, and which symmetry the horizontal angles say.
IesProfile IesProfile::read(std::string_view text, std::string_view name) {
    Numbers file(text, name);
    if (const std::string_view tilt = file.skipToTilt(); tilt == "INCLUDE") skipTilt(file);

    file.number("the number of lamps");
    file.number("the lumens per lamp");
    double factor = file.notNegative("the candela multiplier");
    const std::size_t verticals = file.count("the number of vertical angles", 2);
    const std::size_t horizontals = file.count("the number of horizontal angles", 1);
    const std::size_t type = file.count("the photometric type", 1, 3);
    if (type != 1)
        throw file.error("its photometric type is {}; woodcock reads type C (1)",
                         type == 2 ? "B (2)" : "A (3)");
    for (const char* what : {"the unit of lengths", "the width", "the length", "the height"})
        file.number(what);
    factor *= file.notNegative("the ballast factor");
    factor *= file.notNegative("the ballast-lamp photometric factor");
    file.number("the input watts");

    IesProfile profile;
    profile.vertical_ = file.angles("vertical angle", verticals);
    checkVertical(file, profile.vertical_);
    const std::vector<double> given = file.angles("horizontal angle", horizontals);
    const double first = given.front(), last = given.back();
    // Some files leave out 360, where everything is as at 0.
    const bool open = first == 0 && given.size() > 2 && last > 180 && last < 360 &&
                      360 - last <= given[1] - given[0] + 1e-6;
    const bool known = (first == 0 && (last == 0 || last == 90 || last == 180 || last == 360)) ||
                       (first == 90 && last == 270) || open;
    if (!known)
        throw file.error(
            "the horizontal angles go from {:g} to {:g}; in a file of type C there is 0 alone, or "
            "they go from 0 to 90, 180 or 360, or from 90 to 270",
            first, last);

    std::vector<std::vector<double>> columns(horizontals);
    for (std::size_t h = 0; h < horizontals; ++h)
        for (std::size_t v = 0; v < verticals; ++v)
            columns[h].push_back(
                fromCandela * factor *
                file.notNegative(fmt::format("the candela at horizontal angle {:g}, vertical {:g}",
                                             given[h], profile.vertical_[v])));
    file.expectEnd();

    // All around, by the symmetry: the planes of every angle at which the file has numbers.
    std::vector<std::pair<double, std::size_t>> planes;
    for (std::size_t h = 0; h < horizontals; ++h) {
        const double angle = given[h];
        const auto add = [&](double a) { planes.emplace_back(a < 0 ? a + 360 : a, h); };
        add(angle);
        if (last == 90 || last == 180) add(360 - angle);
        if (last == 90) add(180 - angle), add(180 + angle);
        if (first == 90 && last == 270) add(180 - angle);  // the plane of 90 and 270
    }
    std::sort(planes.begin(), planes.end());
    planes.erase(std::unique(planes.begin(), planes.end(),
                             [](const auto& a, const auto& b) { return a.first == b.first; }),
                 planes.end());
    // From 0 to 360, where the plane of 0 may lie between two others.
    if (const auto [after, next] = planes.front(); after > 0) {
        const auto [before, previous] = planes.back();
        const double share = (360 - before) / (360 - before + after);
        std::vector<double> between;
        for (std::size_t v = 0; v < verticals; ++v)
            between.push_back(columns[previous][v] * (1 - share) + columns[next][v] * share);
        planes.emplace(planes.begin(), 0, columns.size());
        columns.push_back(std::move(between));
    }
    if (planes.back().first < 360) planes.emplace_back(360, planes.front().second);
    for (const auto& [angle, h] : planes) {
        profile.horizontal_.push_back(angle);
        profile.value_.insert(profile.value_.end(), columns[h].begin(), columns[h].end());
    }
    profile.maximum_ = *std::max_element(profile.value_.begin(), profile.value_.end());
    if (!(profile.maximum_ <= std::numeric_limits<float>::max()))
        throw file.error("the candela times their factors are more than a float can hold");
    return profile;
}

namespace {

/// The index of the step of `list` that holds `x`, and where in it `x` lies.
std::pair<std::size_t, double> stepOf(const std::vector<double>& list, double x) {
    const auto above = std::upper_bound(list.begin() + 1, list.end() - 1, x);
    const auto i = static_cast<std::size_t>(above - list.begin()) - 1;
    return {i, std::clamp((x - list[i]) / (list[i + 1] - list[i]), 0.0, 1.0)};
}

}  // namespace

double IesProfile::value(Vec3d d) const {
    constexpr double degrees = 180 / pi;
    const double across = std::hypot(d.x, d.y);
    const double v = std::atan2(across, -d.z) * degrees;
    if (v < vertical_.front() || v > vertical_.back()) return 0;
    const double h = std::atan2(d.x, d.y) * degrees + 180;
    const auto [i, fi] = stepOf(horizontal_, h);
    const auto [j, fj] = stepOf(vertical_, v);
    return (at(i, j) * (1 - fj) + at(i, j + 1) * fj) * (1 - fi) +
           (at(i + 1, j) * (1 - fj) + at(i + 1, j + 1) * fj) * fi;
}

double IesProfile::mean() const {
    double sum = 0;
    for (std::size_t j = 0; j + 1 < vertical_.size(); ++j) {
        // Of a (1 - f) + b f over the sine, f from 0 to 1 between two angles.
        const double t0 = vertical_[j] * pi / 180, t1 = vertical_[j + 1] * pi / 180;
        const double all = std::cos(t0) - std::cos(t1), width = t1 - t0;
        const double second = (std::sin(t1) - std::sin(t0) - width * std::cos(t1)) / width;
        for (std::size_t i = 0; i + 1 < horizontal_.size(); ++i) {
            const double turn = (horizontal_[i + 1] - horizontal_[i]) * pi / 180 / 2;
            for (std::size_t k : {i, i + 1})
                sum += turn * (at(k, j) * (all - second) + at(k, j + 1) * second);
        }
    }
    return sum / (4 * pi);
}

}  // namespace woodcock::light
