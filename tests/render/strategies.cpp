// placeholder, replaced below
#include "support/checks.h"
#include "support/device.h"
#include "support/seeds.h"
using namespace opal;
using namespace opal::test;
TEST_CASE("Strategies of one expectation agree", "[strategies]") { require_all_pass(check_agreement(Sources::embedded(), test_seed(10))); }
