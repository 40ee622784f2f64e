// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/toml_reader.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <thread>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/base/toml_nesting.h"

namespace woodcock::test {

namespace {

std::string keyOf(std::size_t parts) {
    std::string key = "a";
    for (std::size_t i = 1; i < parts; ++i) key += ".a";
    return key;
}

TEST(TomlNesting, KeysHaveAnEnd) {
    for (const std::string before : {"", "x = 1\n", "[t]\n"}) {
        EXPECT_NO_THROW(parseToml(before + keyOf(mostKeyParts) + " = 1", "f"));
        expectError(ErrorKind::Input, "a key has more than 32 parts",
                    [&] { parseToml(before + keyOf(mostKeyParts + 1) + " = 1", "f"); });
    }
    for (const std::string& text :
         {"[" + keyOf(100000) + "]", "x = {" + keyOf(100000) + " = 1}",
          "x = [{" + keyOf(100000) + " = 1}]", "\"a\" . 'b' . " + keyOf(100000) + " = 1"})
        expectError(ErrorKind::Input, "f:1: a key has more than 32 parts",
                    [&] { parseToml(text, "f"); });
}

TEST(TomlNesting, DotsElsewhereAreNoKeys) {
    const std::string dots(1000, '.');
    EXPECT_NO_THROW(parseToml("a = \"" + dots + "\\\"" + dots + "\" # " + dots +  //
                                  "\nb = '" + dots + "'\n" +                      //
                                  "c = '''\n" + dots + "\n'''\n" +                //
                                  "d = \"\"\"\n" + dots + "\"" + dots + "\\\"\n\"\"\"\n" +
                                  "e = [1.5, 2.5]",
                              "f"));
}

TEST(TomlNesting, ValuesHaveAnEndToo) {
    for (const char* const open : {"[", "{a="})
        expectError(ErrorKind::Input, "f:1:", [&] {
            std::string text = "a = ";
            for (int i = 0; i < 100000; ++i) text += open;
            parseToml(text, "f");
        });
}

TEST(TomlReader, APipeIsReadAndEndlessOnesAreNot) {
    const TempDir dir;
    ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
    std::thread writer([&] { writeText(dir / "pipe", "a = 1"); });
    EXPECT_EQ(readTomlFile(dir / "pipe", "recipe"), "a = 1");
    writer.join();
    expectError(ErrorKind::Input, "recipe '/dev/zero' is larger than 4 MB",
                [] { readTomlFile("/dev/zero", "recipe"); });
}

TEST(TomlReader, MessagesQuoteNoMoreThanIsRead) {
    const std::string longWord(1 << 20, 'x');
    const toml::table table = parseToml("a = \"" + longWord + "\"\n" + longWord + " = 1", "f");
    const TomlTable read(table, "");
    const std::vector<std::string> known{"one", "two"};
    for (const std::string& message :
         {messageOf(ErrorKind::Input, [&] { read.find("a")->choice("kind", known); }),
          messageOf(ErrorKind::Input, [&] { read.allowOnly({"a"}, "the file"); }),
          messageOf(ErrorKind::Input, [&] { read.find(longWord)->text(); })}) {
        EXPECT_NE(message.find("xxx..."), std::string::npos);
        EXPECT_LT(message.size(), 400u);
    }
}

}  // namespace
}  // namespace woodcock::test
