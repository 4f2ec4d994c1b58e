// Random seeds of the tests: the same ones every time, others where $OPAL_TEST_SEED is a number other than 0.
#pragma once

namespace opal::test {

// A seed of its own for each `salt`, reproducible from $OPAL_TEST_SEED (0 where it is not set).
unsigned test_seed(unsigned salt);

} // namespace opal::test
