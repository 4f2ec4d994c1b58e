#include "base/json.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace opal;

TEST_CASE("whole numbers are read from JSON that they can hold, and others are refused", "[json]") {
    CHECK(parse_json("7").get<unsigned>() == 7);
    CHECK(parse_json("-7").get<int>() == -7);
    CHECK(parse_json("4294967295").get<unsigned>() == 4294967295u);
    CHECK(parse_json("18446744073709551615").get<unsigned long long>() == 18446744073709551615u);
    CHECK(nlohmann::json(std::numeric_limits<int>::min()).get<int>() == std::numeric_limits<int>::min());
    for (const char *text : {"-1", "4294967296", "1e308", "0.5", "true", "\"7\"", "null"}) {
        INFO(text);
        CHECK_THROWS_AS(parse_json(text).get<unsigned>(), nlohmann::json::exception);
    }
    for (const char *text : {"2147483648", "-2147483649", "1e308"})
        CHECK_THROWS_AS(parse_json(text).get<int>(), nlohmann::json::exception);
    CHECK(parse_json("1e308").get<double>() == 1e308); // numbers that need not be whole are as before
    CHECK(parse_json("true").get<bool>());
}
