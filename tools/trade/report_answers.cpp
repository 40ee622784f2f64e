// SPDX-License-Identifier: Apache-2.0
#include "tools/trade/report_answers.h"

#include <fmt/core.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "woodcock/trade/askable.h"

namespace woodcock::tool {

namespace {

using nlohmann::json;
using trade::Among;
using trade::Measured;
using trade::TradeModel;
using Models = std::vector<TradeModel>;

/// Beyond what is sensible, as far as anybody asks.
constexpr trade::Range anyTime{1e-3, 1e6}, anyError{1e-10, 10};
/// What the page shows. More digits would take room alone.
constexpr int valueDigits = 5, errorDigits = 2;

double rounded(double v, int digits) {
    return std::strtod(fmt::format("{:.{}g}", v, digits).c_str(), nullptr);
}

/// What is asked for: a time or an error.
struct Question {
    std::optional<trade::Winner> (*winner)(const Models&, double target, Among);
    std::optional<Measured> (TradeModel::*value)(double target) const;
    double (*samples)(const TradeModel&, double target);
};
constexpr Question ofTime{&trade::bestAt, &TradeModel::errorAt,
                          [](const TradeModel& m, double t) { return m.samplesIn(t); }};
constexpr Question ofError{&trade::fastestTo, &TradeModel::secondsTo,
                           [](const TradeModel& m, double e) { return *m.samplesTo(e); }};

json chosen(const Question& question, const Models& models, const std::vector<double>& targets,
            Among among) {
    json best = json::array(), tied = best, recommended = best, samples = best;
    for (const double target : targets) {
        const auto winner = question.winner(models, target, among);
        best.push_back(winner ? json(winner->best) : json());
        tied.push_back(winner ? json(winner->tied) : json());
        recommended.push_back(winner ? json(winner->recommended) : json());
        samples.push_back(winner ? json(question.samples(models[winner->recommended], target))
                                 : json());
    }
    return {{"best", std::move(best)},
            {"tied", std::move(tied)},
            {"recommended", std::move(recommended)},
            {"samples", std::move(samples)}};
}

json weighed(const Question& question, const Models& models, const std::vector<double>& targets) {
    json values = json::array(), errors = json::array();
    for (const TradeModel& model : models) {
        json value = json::array(), error = json::array();
        for (const double target : targets) {
            const std::optional<Measured> m = (model.*question.value)(target);
            value.push_back(m ? json(rounded(m->value, valueDigits)) : json());
            error.push_back(m ? json(rounded(m->se, errorDigits)) : json());
        }
        values.push_back(std::move(value)), errors.push_back(std::move(error));
    }
    return {{"value", std::move(values)},
            {"se", std::move(errors)},
            {"all", chosen(question, models, targets, Among::All)},
            {"unbiased", chosen(question, models, targets, Among::Unbiased)}};
}

json answers(const Question& question, const trade::TradeResult& result, trade::Range sensible,
             trade::Range any) {
    const std::vector<double> targets = trade::roundNumbers(sensible, any);
    json all{{"targets", targets}, {"sensible", {sensible.low, sensible.high}}};
    all["rendering"] = weighed(question, result.models(trade::Counted::Rendering), targets);
    all["with_loading"] = weighed(question, result.models(trade::Counted::LoadingToo), targets);
    return all;
}

}  // namespace

json answersJson(const trade::TradeResult& result, double budget) {
    const trade::Range times = trade::sensibleTimes(result, budget);
    json costs = json::array();
    for (const TradeModel& model : result.models())
        costs.push_back(model.costs.empty() ? json() : json(model.cost()));
    return {{"cost", std::move(costs)},
            {"time", answers(ofTime, result, times, anyTime)},
            {"error", answers(ofError, result, trade::sensibleErrors(result, times), anyError)}};
}

}  // namespace woodcock::tool
