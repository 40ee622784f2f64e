// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/base/toml_reader.h"

namespace woodcock::bake {

/// A number of a recipe that its user may choose.
struct Parameter {
    std::string name, about{};
    double value = 0, standard = 0;
    std::optional<double> lower{}, upper{};
    bool integer = false;
};

/// A recipe's parameters and derived numbers, and expressions of both.
class ParameterSet {
public:
    ParameterSet();
    ~ParameterSet();
    ParameterSet(ParameterSet&&) noexcept;
    ParameterSet& operator=(ParameterSet&&) noexcept;

    /// Errors: Input (of a default outside its range, say), with the place.
    void declare(const std::string& name, const TomlValue& value);
    /// `origin` is the source of the value, such as "--set size=3". Errors: Usage, when there is no
    /// such parameter, or the value is outside its range.
    void set(const std::string& name, double value, std::string_view origin);
    /// Adds a number that follows from others. Errors: Input, for expressions that need each other.
    void derive(const TomlTable& definitions);

    /// A number, or a string with an expression: + - * / ^, comparisons, c ? a : b, sin, cos, sqrt,
    /// exp, min, max, abs, ... of the names. Errors: Input, with the place.
    double evaluate(const TomlValue& value) const;

    const std::vector<Parameter>& all() const { return parameters_; }
    double at(std::string_view name) const;

private:
    struct Parser;
    void define(const std::string& name, double value);
    double evaluate(const std::string& expression, const TomlValue& where) const;

    std::vector<Parameter> parameters_;
    std::map<std::string, double, std::less<>> values_;
    std::unique_ptr<Parser> parser_;
};

}  // namespace woodcock::bake
