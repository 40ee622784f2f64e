// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "woodcock/base/error.h"

namespace woodcock::test {

/// `act` must throw an Error of this kind whose message holds `part`.
template <class F>
void expectError(ErrorKind kind, const std::string& part, F&& act) {
    try {
        act();
        ADD_FAILURE() << "no error; expected: " << part;
    } catch (const Error& e) {
        EXPECT_EQ(static_cast<int>(e.kind()), static_cast<int>(kind)) << e.what();
        EXPECT_NE(std::string(e.what()).find(part), std::string::npos)
            << "expected: " << part << "\nfound:    " << e.what();
    }
}

/// The message of the Error of this kind that `act` throws; "no error" when it throws none.
template <class F>
std::string messageOf(ErrorKind kind, F&& act) {
    try {
        act();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), kind) << e.what();
        return e.what();
    }
    return "no error";
}

}  // namespace woodcock::test
