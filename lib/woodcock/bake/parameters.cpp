// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/parameters.h"

#include <muParser.h>

#include <cmath>
#include <functional>
#include <set>

#include "woodcock/base/nearest_name.h"
#include "woodcock/base/printable.h"

namespace woodcock::bake {

struct ParameterSet::Parser {
    mu::Parser parser;
};

ParameterSet::ParameterSet() : parser_(std::make_unique<Parser>()) {
    define("pi", pi);
    parser_->parser.DefineFun(
        "floor", +[](double v) { return std::floor(v); });
    parser_->parser.DefineFun(
        "ceil", +[](double v) { return std::ceil(v); });
    parser_->parser.DefineFun(
        "clamp", +[](double v, double low, double high) { return std::clamp(v, low, high); });
    parser_->parser.DefineFun(
        "mix", +[](double a, double b, double t) { return a + (b - a) * t; });
}
ParameterSet::~ParameterSet() = default;
ParameterSet::ParameterSet(ParameterSet&&) noexcept = default;
ParameterSet& ParameterSet::operator=(ParameterSet&&) noexcept = default;

void ParameterSet::define(const std::string& name, double value) {
    values_[name] = value;
    parser_->parser.DefineConst(name, value);
}

double ParameterSet::at(std::string_view name) const { return values_.find(name)->second; }

void ParameterSet::declare(const std::string& name, const TomlValue& value) {
    Parameter p{.name = name};
    if (!value.isTable()) {
        p.standard = value.number();
    } else {
        const TomlTable table = value.table();
        table.allowOnly({"default", "range", "about", "integer"}, "a parameter");
        p.standard = table.need("default", "default = 1").number();
        if (const auto about = table.find("about")) p.about = about->text();
        if (const auto integer = table.find("integer")) p.integer = integer->flag();
        if (const auto range = table.find("range")) {
            const auto ends = range->elements("[lowest, highest]", 2);
            p.lower = ends[0].number(), p.upper = ends[1].number({*p.lower});
            if (p.standard < *p.lower || p.standard > *p.upper)
                throw value.error("has a default outside its range");
        }
    }
    p.value = p.standard;
    try {
        define(name, p.value);
    } catch (const mu::Parser::exception_type&) {
        throw value.error("cannot be the name of a parameter; expected letters, digits and _");
    }
    std::erase_if(parameters_, [&](const Parameter& other) { return other.name == name; });
    parameters_.push_back(std::move(p));
}

void ParameterSet::set(const std::string& name, double value, std::string_view origin) {
    std::vector<std::string> known;
    for (Parameter& p : parameters_) {
        known.push_back(p.name);
        if (p.name != name) continue;
        if (p.lower && (value < *p.lower || value > *p.upper))
            throw usageError("{}: {} must lie between {} and {}", origin, name, *p.lower, *p.upper);
        if (p.integer && value != std::floor(value))
            throw usageError("{}: {} must be a whole number", origin, name);
        p.value = value;
        define(name, value);
        return;
    }
    throw usageError("{}: the recipe has no parameter '{}'{}", origin, name,
                     suggestName(name, "parameters", known));
}

void ParameterSet::derive(const TomlTable& definitions) {
    std::set<std::string> open, done;
    std::size_t depth = 0;
    std::function<void(const std::string&)> visit = [&](const std::string& name) {
        const TomlValue value = *definitions.find(name);
        if (done.contains(name)) return;
        if (!open.insert(name).second) throw value.error("needs itself");
        constexpr std::size_t deepest = 100;  // each takes some of the stack
        if (++depth > deepest)
            throw value.error("needs a chain of more than {} other parameters", deepest);
        if (values_.contains(name)) throw value.error("is already a parameter");
        if (value.isText()) {
            mu::Parser parser = parser_->parser;
            try {
                parser.SetExpr(value.text());
                for (const auto& used : parser.GetUsedVar())
                    if (definitions.has(used.first)) visit(used.first);
            } catch (const mu::Parser::exception_type&) {
                // evaluate() tells what is wrong with it.
            }
        }
        const double result = evaluate(value);
        try {
            define(name, result);
        } catch (const mu::Parser::exception_type&) {
            throw value.error("cannot be a name; expected letters, digits and _");
        }
        done.insert(name);
        --depth;
    };
    for (const std::string& name : definitions.keys()) visit(name);
}

double ParameterSet::evaluate(const TomlValue& value) const {
    if (!value.isText()) return value.number();
    return evaluate(value.text(), value);
}

double ParameterSet::evaluate(const std::string& expression, const TomlValue& where) const {
    double result = 0;
    try {
        mu::Parser parser = parser_->parser;
        parser.SetExpr(expression);
        result = parser.Eval();
    } catch (const mu::Parser::exception_type& e) {
        std::vector<std::string> known;
        for (const auto& entry : values_) known.push_back(entry.first);
        if (e.GetCode() == mu::ecUNASSIGNABLE_TOKEN)
            throw where.error("= \"{}\": unknown name '{}'{}", shown(expression),
                              shown(e.GetToken()), suggestName(e.GetToken(), "known", known));
        throw where.error("= \"{}\": {}", shown(expression), shown(e.GetMsg()));
    }
    if (!std::isfinite(result)) throw where.error("= \"{}\" is {}", shown(expression), result);
    return result;
}

}  // namespace woodcock::bake
