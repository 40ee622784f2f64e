// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/medium_runs.h"

#include <gtest/gtest.h>

namespace woodcock::test {

using namespace render;

namespace {

struct Query {
    std::uint32_t medium, visits = 0, metAs = 0;
};

void visitAll(MediumRuns& runs, std::vector<Query>& queries) {
    std::vector<Query> sorted;
    runs.forEach(
        queries, sorted,
        [&](std::uint32_t medium, std::span<Query> run, std::span<const MediumRuns::Item> items) {
            ASSERT_EQ(run.size(), items.size());
            for (std::size_t k = 0; k < run.size(); ++k) {
                EXPECT_EQ(run[k].medium, medium);
                ++run[k].visits, run[k].metAs = items[k].query;
            }
        });
}

TEST(MediumRuns, EachQueryIsVisitedOnceAmongItsOwn) {
    MediumRuns runs;
    for (const std::uint32_t media : {1u, 2u, 7u}) {
        std::vector<Query> queries;
        for (std::uint32_t i = 0; i < 50; ++i) queries.push_back({i * i % media});
        runs.clear();
        for (std::size_t i = 0; i < queries.size(); ++i) runs.add(queries[i].medium, i);
        visitAll(runs, queries);
        for (std::uint32_t i = 0; i < queries.size(); ++i) {
            EXPECT_EQ(queries[i].visits, 1u);
            EXPECT_EQ(queries[i].metAs, i);
            EXPECT_EQ(queries[i].medium, i * i % media);
        }
    }
}

TEST(MediumRuns, OthersAreLeftAlone) {
    MediumRuns runs;
    std::vector<Query> queries(20, Query{3});
    for (std::size_t i = 0; i < queries.size(); i += 2) runs.add(3, i);
    visitAll(runs, queries);
    for (std::size_t i = 0; i < queries.size(); ++i)
        EXPECT_EQ(queries[i].visits, i % 2 == 0 ? 1u : 0u);
}

}  // namespace
}  // namespace woodcock::test
