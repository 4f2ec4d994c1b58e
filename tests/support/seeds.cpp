#include "support/seeds.h"

#include <cstdlib>

namespace opal::test {

unsigned test_seed(unsigned salt) {
    static const unsigned long long given = [] {
        const char *text = std::getenv("OPAL_TEST_SEED");
        return text ? std::strtoull(text, nullptr, 10) : 0ull;
    }();
    // splitmix64 (Steele, Lea, Flood 2014) of the pair
    unsigned long long z = (given << 32 ^ salt) + 0x9e3779b97f4a7c15ull;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ z >> 27) * 0x94d049bb133111ebull;
    return unsigned((z ^ z >> 31) & 0x7fffffff);
}

} // namespace opal::test
