#include "scene/index_of_refraction.h"
#include "read/nori/parsers.h"
#include "support/error_of.h"

#include <catch2/catch.hpp>

using namespace opal;
using opal::test::error_of;

namespace {

bsdf_dielectric_record glass(const std::string &body) {
    const XmlDocument document("a.xml", "<bsdf type='dielectric'>" + body + "</bsdf>");
    return parse_bsdf(document.root(), {}).as<bsdf_dielectric_record>();
}

} // namespace

TEST_CASE("media have the indices that Mitsuba gives them, in any case", "[index_of_refraction]") {
    CHECK(media().size() == 23);
    CHECK(index_of_refraction("bk7") == 1.5046);
    CHECK(index_of_refraction("BK7") == 1.5046);
    CHECK(index_of_refraction("Water Ice") == 1.31);
    CHECK(index_of_refraction("vacuum") == 1);
    CHECK_FALSE(index_of_refraction("waterice"));
    CHECK_FALSE(index_of_refraction(""));
    // The ratios of Mitsuba's dielectric and plastic without parameters
    CHECK(*index_of_refraction("bk7") / *index_of_refraction("air") == Approx(1.504183).epsilon(5e-7));
    CHECK(*index_of_refraction("acrylic glass") / *index_of_refraction("air") == Approx(1.489587).epsilon(5e-7));
}

TEST_CASE("an index of refraction may be a medium's name", "[index_of_refraction]") {
    const auto record = glass("<string name='intIOR' value='Diamond'/><float name='extIOR' value='1.2'/>");
    CHECK(record.int_ior.value == 2.419f);
    CHECK(record.ext_ior.value == 1.2f);
    CHECK(glass("").int_ior.value == 1.5046f);
    CHECK_THAT(error_of([] { glass("<string name='intIOR' value='watr'/>"); }),
               Catch::Contains("property 'intIOR': unknown medium 'watr'; did you mean 'water'?"));
    CHECK_THAT(error_of([] { glass("<boolean name='intIOR' value='true'/>"); }), Catch::Contains("intIOR"));
}
