// Reconstruction filters.
#include "support/checks.h"
#include "support/device.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

TEST_CASE("Filters keep constants, weigh as they should and blur an edge as known", "[filters][stat]") {
    require_all_pass(check_filters(Sources::embedded(), test_seed(60)));
}
