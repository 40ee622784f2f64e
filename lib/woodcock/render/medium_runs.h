// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace woodcock::render {

/// Sorts queries into runs that go through one medium, as the walks want them. The order of queries
/// changes no result, as each has its own random stream.
class MediumRuns {
public:
    struct Item {
        std::uint32_t medium;
        std::uint32_t query;  ///< its index
        auto operator<=>(const Item&) const = default;
    };

    void clear() { items_.clear(), even_ = true; }
    /// The query of this index goes through this medium. Each query is added at most once, in their
    /// order.
    void add(std::uint32_t medium, std::size_t query) {
        items_.push_back({medium, static_cast<std::uint32_t>(query)});
        even_ = even_ && medium == items_.front().medium;
    }

    /// Calls f(medium, queries, items) for each run. Where all queries are of one medium they stay
    /// where they are. Otherwise f gets copies in `sorted`, which are copied back.
    template <class Query, class F>
    void forEach(std::vector<Query>& queries, std::vector<Query>& sorted, F&& f) {
        if (items_.empty()) return;
        const std::span<const Item> items(items_);
        if (even_ && items.size() == queries.size()) {
            f(items.front().medium, std::span(queries), items);
            return;
        }
        if (!even_) std::sort(items_.begin(), items_.end());
        sorted.clear();
        for (const Item& item : items) sorted.push_back(queries[item.query]);
        for (std::size_t first = 0, end = 0; first < items.size(); first = end) {
            const std::uint32_t medium = items[first].medium;
            while (end < items.size() && items[end].medium == medium) ++end;
            f(medium, std::span(sorted).subspan(first, end - first),
              items.subspan(first, end - first));
        }
        for (std::size_t k = 0; k < items.size(); ++k) queries[items[k].query] = sorted[k];
    }

private:
    std::vector<Item> items_;
    bool even_ = true;  // all of one medium
};

}  // namespace woodcock::render
