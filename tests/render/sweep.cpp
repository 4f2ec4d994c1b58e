// `opal sweep` as its users meet it, on a scene of a few pixels: slopes, the page, resuming, refusals.
#include "base/exit_code.h"
#include "base/json.h"
#include "image/image.h"
#include "read/nori/load.h"
#include "support/device.h"
#include "support/scratch.h"
#include "sweep/lock.h"
#include "sweep/run.h"

#include <unistd.h>

using namespace opal;
using namespace opal::test;

namespace {

// A floor under a small lamp, which BSDF samples seldom find.
const char *const scene_text = R"(<scene>
  <integrator type="path_mis"><integer name="maxDepth" value="2"/></integrator>
  <camera type="perspective"><integer name="width" value="24"/><integer name="height" value="16"/></camera>
  <mesh type="parallelogram">
    <point name="origin" value="-3 -3 5"/><vector name="u" value="0 6 0"/><vector name="v" value="6 0 0"/>
    <bsdf type="diffuse"><color name="albedo" value="0.8 0.8 0.8"/></bsdf>
  </mesh>
  <mesh type="parallelogram">
    <point name="origin" value="-0.4 -0.4 4"/><vector name="u" value="0.8 0 0"/><vector name="v" value="0 0.8 0"/>
    <emitter type="area"><color name="radiance" value="3 3 3"/></emitter>
  </mesh>
</scene>
)";

struct SceneFolder {
    ScratchFolder scratch;
    std::string scene = scratch.write("lamp.xml", scene_text).string();
    Outcome sweep(const std::string &arguments) const {
        return run_shell("cd " + scratch.path().string() + " && " + OPAL_BINARY + " sweep " + scene + " " + arguments);
    }
    nlohmann::json record() const { return nlohmann::json::parse(read_text(scratch / "out/sweep.json")); }
};

size_t count(const std::string &text, const std::string &word) {
    size_t n = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        n++;
    return n;
}

} // namespace

TEST_CASE("A sweep ranks strategies, tells it on one page, and goes on where it stopped", "[sweep][stat]") {
    const SceneFolder folder;
    const std::string what = "--strategies lighting=bsdf lighting=emitter --spp 16,64 --reference-spp 4096 -o out ";
    const Outcome first = folder.sweep(what + "--replicates 3");
    INFO(first.err);
    REQUIRE(first.exit_code == 0);
    CHECK_THAT(first.out,
               Catch::Contains("lighting=emitter is the fastest") && Catch::Contains("lighting=bsdf needs "));
    const nlohmann::json record = folder.record();
    REQUIRE(record["strategies"].size() == 2);
    for (const auto &strategy : record["strategies"]) {
        const double mse16 = strategy["points"][0]["replicates"][0]["mse"],
                     mse64 = strategy["points"][1]["replicates"][0]["mse"];
        CHECK(mse16 / mse64 == Approx(4).epsilon(0.5)); // 384 pixels: the error of an MSE is some 10 %
    }
    const std::string page = read_text(folder.scratch / "out/index.html");
    CHECK(count(page, "data:image/png;base64,") == 5); // the reference, and an image and an error map of each strategy
    CHECK(count(page, "<circle") == 2 * 2 + 2);        // the points, the legend
    CHECK(count(page, "http") == 0);                   // nothing from elsewhere
    CHECK(count(read_text(folder.scratch / "out/sweep.csv"), "\n") == 1 + 4);

    // With more replicates the earlier ones stay, to the last digit of their seconds, and so does the reference.
    const Outcome second = folder.sweep(what + "--replicates 4");
    INFO(second.err);
    REQUIRE(second.exit_code == 0);
    const nlohmann::json longer = folder.record();
    CHECK(longer["reference"] == record["reference"]);
    for (size_t s : {0, 1})
        for (size_t p : {0, 1}) {
            nlohmann::json replicates = longer["strategies"][s]["points"][p]["replicates"];
            REQUIRE(replicates.size() == 4);
            replicates.erase(3);
            CHECK(replicates == record["strategies"][s]["points"][p]["replicates"]);
        }

    const Outcome other = folder.sweep(what + "--replicates 3 --width 12");
    CHECK(other.exit_code == 1);
    CHECK_THAT(other.err, Catch::Contains("holds another sweep (width was 24, is 12)"));
}

TEST_CASE("The slope of every independent unbiased strategy is -1 within its interval", "[sweep][stat]") {
    const std::string integrator = GENERATE("path_mis", "direct_lighting");
    CAPTURE(integrator);
    const SceneFolder folder;
    const Outcome outcome =
        folder.sweep("--integrator " + integrator + " --spp 32,128,512 --replicates 8 --reference-spp 32768 -o out");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const nlohmann::json record = folder.record();
    CHECK(record["strategies"].size() == (integrator == "path_mis" ? 5 : 6));
    for (const nlohmann::json &strategy : record["strategies"]) {
        double mean = 0, squares = 0;
        for (int r = 0; r < 8; r++) { // least squares on three equally spaced points: the outer two decide
            const auto mse = [&](int p) { return strategy["points"][p]["replicates"][r]["mse"].get<double>(); };
            const double slope = std::log(mse(2) / mse(0)) / std::log(16.0);
            mean += slope / 8;
            squares += slope * slope / 8;
        }
        const double error = std::sqrt((squares - mean * mean) / 7);
        INFO(strategy["name"] << ": slope " << mean << " +- " << error);
        CHECK(error < 0.05);
        CHECK(std::abs(mean + 1) < 6 * error); // t with 7 degrees of freedom: p = 0.0005, of eleven strategies
    }
}

TEST_CASE("With --vary there is a sweep for each value, with its own reference, and a table over the values",
          "[sweep]") {
    SceneFolder folder;
    std::string text = scene_text;
    text.replace(text.find("0.8 0.8 0.8"), 11, "$a $a $a");
    folder.scene = folder.scratch.write("lamp.xml", text);
    const std::string how = "--strategies lighting=bsdf lighting=emitter --spp 4 --replicates 2 -o out ";
    const Outcome outcome = folder.sweep(how + "--vary a=0.2,0.8");
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const auto of = [&](const std::string &file) {
        return nlohmann::json::parse(read_text(folder.scratch / ("out/" + file)));
    };
    const nlohmann::json dark = of("a=0.2/sweep.json"), bright = of("a=0.8/sweep.json"), table = of("vary.json");
    CHECK(dark["definitions"]["a"] == "0.2");
    // The camera sees the lamp from behind, and so nothing but light that the floor reflects.
    CHECK(bright["reference"]["mean_luminance"].get<double>() ==
          Approx(4 * dark["reference"]["mean_luminance"].get<double>()));
    CHECK(table["vary"] == "a");
    REQUIRE(table["values"].size() == 2);
    for (const auto &[value, sweep] : {std::pair{table["values"][0], dark}, {table["values"][1], bright}}) {
        CHECK(value["strategies"] == sweep["summary"]);
        CHECK(value["fastest"] == "lighting=emitter");
        const std::string name = value["value"];
        CHECK_THAT(read_text(folder.scratch / "out/index.html"),
                   Catch::Contains("href=\"a=" + name + "/index.html\">" + name + "</a>"));
        CHECK(value["folder"] == "out/a=" + name);
        CHECK(std::filesystem::exists(folder.scratch / ("out/a=" + name + "/index.html")));
        CHECK_THAT(outcome.out,
                   Catch::Matches("(.|\n)*\n" + name + " +lighting=emitter +[0-9.e-]+ s .* the fastest\n(.|\n)*"));
    }
    const auto refused = [&](const std::string &arguments, const std::string &reason, int code = exit_usage) {
        const Outcome refusal = folder.sweep(how + arguments);
        INFO(arguments << "\n" << refusal.err);
        CHECK(refusal.exit_code == code);
        CHECK_THAT(refusal.err, Catch::Contains(reason));
    };
    refused("--vary a", "is not NAME=V1,V2,...");
    refused("--vary a=0.2", "needs at least two values");
    refused("--vary a=0.2,0.3,0.2", "two values would share the folder a=0.2");
    refused("--vary a=0.2,0.3 -D a=1", "-D gives a, too");
    refused("--vary a=0.2,0.3 --reference a.exr", "--vary and --reference exclude each other");
    refused("--vary b=0.2,0.3 -D a=1", "unknown name of -D 'b'");
    refused("--vary a=0.4,bright", "bright", exit_failed); // before anything is rendered
    CHECK_FALSE(std::filesystem::exists(folder.scratch / "out/a=0.4"));
    refused("-D a=0.2", "out: holds a sweep with --vary", exit_failed);
}

TEST_CASE("Names of any bytes are swept, and gone on with", "[sweep]") {
    SceneFolder folder;
    folder.scene = folder.scratch.write("l\344mp.xml", scene_text);
    REQUIRE(run_shell("cd " + folder.scratch.path().string() + " && " OPAL_BINARY " " + folder.scene +
                      " --spp 1 -o r\344f.exr")
                .exit_code == 0);
    for (const std::string replicates : {"2", "3"}) {
        const Outcome outcome = folder.sweep(
            "--strategies lighting=emitter lighting=mis --spp 2 --reference r\344f.exr -o out --replicates " +
            replicates);
        INFO(outcome.err);
        CHECK(outcome.exit_code == 0);
        CHECK_THAT(folder.record()["scene"].get<std::string>(), Catch::EndsWith("l\\xe4mp.xml"));
        CHECK(folder.record()["strategies"][0]["points"][0]["replicates"].size() == std::stoul(replicates));
    }
    std::filesystem::remove(folder.scratch / "out/equal_time_1.png"); // a picture that is missing is made again
    CHECK(
        folder.sweep("--strategies lighting=emitter lighting=mis --spp 2 --reference r\344f.exr -o out --replicates 3")
            .exit_code == 0);
    CHECK(std::filesystem::exists(folder.scratch / "out/equal_time_1.png"));
}

TEST_CASE("What makes no sense is refused before anything is rendered", "[sweep]") {
    const SceneFolder folder;
    const auto refused = [&](const std::string &arguments, const std::string &reason, int code = exit_usage) {
        const Outcome outcome = folder.sweep(arguments + " -o out");
        INFO(arguments << "\n" << outcome.err);
        CHECK(outcome.exit_code == code);
        CHECK_THAT(outcome.err, Catch::Contains(reason));
        CHECK_FALSE(std::filesystem::exists(folder.scratch / "out"));
    };
    refused("--replicates 1", "possible: 2 to ");
    refused("--spp 0", "--spp: 0 is out of range; possible: 1 to ");
    refused("--strategies lighting=bdsf", "unknown lighting 'bdsf'; available: bsdf, emitter, mis");
    refused("--strategies coarse",
            "neither a preset (course, all) nor a list axis=value,...; axes: integrator, lighting, mis,");
    refused("--strategies mis=one-sample", "makes no sense");
    refused("--strategies lighting=mis lighting=mis",
            "strategy 'lighting=mis' is the same as 'lighting=mis' on this scene");
    refused("--strategies 'lighting=mis;lighting=mis,mis=balance'", "is the same as");
    refused("--strategies lighting=mis integrator=ao", "estimate different images");
    refused("--strategies lighting=mis lighting=mis,max-depth=5", "estimate different images");
    refused("--integrator normals", "integrator normals has none: name strategies");
    refused("--math precise,quick", "unknown math 'quick'; available: precise, fast, double");
    refused("--math fast,fast", "is the same as");
    refused("--device 0,99", "no OpenCL device \"99\"; available: 0 (", exit_failed);
    refused("--device 0,0", "'0' and '0' are the same device", exit_failed);
    refused("--budget soon", "is no duration");
    refused("--reference none.exr", "none.exr", exit_failed);
}

TEST_CASE("A reference of another size, scene or without colours is refused before anything is rendered", "[sweep]") {
    const SceneFolder folder;
    folder.scratch.write("other.xml", scene_text);
    const auto in_place = [&](const std::string &command) {
        return run_shell("cd " + folder.scratch.path().string() + " && " + OPAL_BINARY + " " + command);
    };
    REQUIRE(in_place("lamp.xml --spp 1 --width 12 -o small.exr").exit_code == 0);
    REQUIRE(in_place("other.xml --spp 1 -o other.exr").exit_code == 0);
    write_exr(Image{24, 16, {{"Z", std::vector<float>(24 * 16)}}, {}}, folder.scratch / "grey.exr");
    for (const auto &[file, reason] : {std::pair{"small.exr", "has 12 x 8 pixels, the scene 24 x 16"},
                                       {"other.exr", "is an image of "},
                                       {"grey.exr", "has no layer R"}}) {
        const Outcome outcome = folder.sweep(std::string("-o out --reference ") + file);
        INFO(outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK_THAT(outcome.err, Catch::Contains(file) && Catch::Contains(reason));
        CHECK_FALSE(std::filesystem::exists(folder.scratch / "out"));
    }
}

TEST_CASE("A sweep of a crop is another sweep, and takes the whole image or the crop for a reference", "[sweep]") {
    const SceneFolder folder;
    const auto in_place = [&](const std::string &command) {
        return run_shell("cd " + folder.scratch.path().string() + " && " + OPAL_BINARY + " " + command);
    };
    REQUIRE(in_place("lamp.xml --spp 64 --no-png -o whole.exr").exit_code == 0);
    REQUIRE(in_place("lamp.xml --spp 64 --no-png -o part.exr --crop 4,3,9,8").exit_code == 0);
    const std::string how = "--strategies lighting=emitter lighting=mis --spp 2 --replicates 2 -o out ";
    const Outcome outcome = folder.sweep(how + "--crop 4,3,9,8 --reference whole.exr");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(read_exr(folder.scratch / "out/equal_time_1.exr").crop == Crop{4, 3, 9, 8, 24, 16});
    const auto with_whole = nlohmann::json::parse(read_text(folder.scratch / "out/sweep.json"));
    CHECK(with_whole["crop"] == "9 x 8 at (4, 3) of 24 x 16");
    CHECK_THAT(folder.sweep(how + "--crop 4,3,9,9 --reference whole.exr").err,
               Catch::Contains("holds another sweep (crop"));
    CHECK_THAT(folder.sweep(how + "--reference part.exr").err,
               Catch::Contains("has 9 x 8 at (4, 3) of 24 x 16 pixels, the scene 24 x 16"));
    std::filesystem::remove_all(folder.scratch / "out");
    REQUIRE(folder.sweep(how + "--crop 4,3,9,8 --reference part.exr").exit_code == 0);
    const auto with_part = nlohmann::json::parse(read_text(folder.scratch / "out/sweep.json"));
    CHECK(with_part["strategies"][0]["points"][0]["replicates"][0]["mse"] ==
          with_whole["strategies"][0]["points"][0]["replicates"][0]["mse"]);
}

TEST_CASE("Several devices and kinds of math are crossed, each device in a process of its own", "[sweep]") {
    if (device().info.platform != "Portable Computing Language") {
        WARN("not tested: only PoCL offers a device twice");
        return;
    }
    const SceneFolder folder;
    const Outcome outcome = run_shell(
        "cd " + folder.scratch.path().string() +
        " && POCL_DEVICES='pthread pthread' OCL_ICD_FILENAMES= OCL_ICD_VENDORS=" + device().info.library + " " +
        OPAL_BINARY +
        " sweep lamp.xml --strategies lighting=emitter --math precise,fast --device 0,1 --spp 8 --replicates 2 -o out");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const nlohmann::json record = folder.record();
    CHECK(record["devices"].size() == 2);
    REQUIRE(record["strategies"].size() == 4);
    for (size_t s = 0; s < 4; s++) {
        const nlohmann::json &strategy = record["strategies"][s];
        CHECK(strategy["device"] == s / 2);
        CHECK(strategy["label"] == std::string("lighting=emitter; ") + (s % 2 ? "fast" : "precise") + " math; device " +
                                       (s / 2 ? "1" : "0"));
        CHECK(strategy["points"][0]["replicates"].size() == 2);
        CHECK(std::filesystem::exists(folder.scratch / ("out/equal_time_" + std::to_string(s + 1) + ".exr")));
    }
}

TEST_CASE("A sweep makes one renderer a strategy", "[sweep]") {
    const SceneFolder folder;
    const std::vector<Candidate> candidates =
        parse_strategies(load_scene(folder.scene), {"lighting=bsdf;lighting=mis;sampler=stratified"}, {});
    const SweepPlan plan{.folder = folder.scratch.path()};
    SweepRecord record;
    record.devices = {{}};
    record.replicates = 2;
    record.spp = {2, 8};
    for (const Candidate &c : candidates)
        record.strategy(c.name, c.label);
    const auto made = [&](SweepPart part = SweepPart::all) {
        return run_sweep(plan, device(), candidates, record, part);
    };
    CHECK(made() == 3);
    for (const StrategyRecord &s : record.strategies)
        CHECK((s.points.size() == 2 && s.points[1].replicates.size() == 2 && s.shot.spp > 0));
    CHECK(made(SweepPart::points) == 0); // all is there
    record.strategies[1].points[0].replicates.pop_back();
    CHECK(made(SweepPart::points) == 1);
}

TEST_CASE("A renderer of a sweep renders what a new one does", "[sweep]") {
    const SceneFolder folder;
    const auto stratified = parse_strategies(load_scene(folder.scene), {"sampler=stratified"}, {}).front();
    const auto fresh = [&] { return CompiledStrategy(device(), stratified, Sources::embedded()); };
    CompiledStrategy used = fresh();
    used.render(3, 5);
    CHECK(used.render(16, 7).film.sum == fresh().render(16, 7).film.sum);
    CHECK(used.render(4, 7).film.sum == fresh().render(4, 7).film.sum);
}

TEST_CASE("A sweep says which kernels it measured, and goes on with them", "[sweep]") {
    const SceneFolder folder;
    const bool cpu = device().info.type != "gpu";
    const auto sweep = [&](const std::string &how) {
        const Outcome outcome =
            folder.sweep("--strategies lighting=emitter lighting=mis --spp 2 --json out.json -o out " + how);
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 0);
        const std::string said = nlohmann::json::parse(read_text(folder.scratch / "out.json"))["kernel"];
        CHECK(folder.record()["kernel"] == said);
        const bool on_page = count(read_text(folder.scratch / "out/index.html"), "--specialise on</code> measures") > 0;
        CHECK(on_page == (said == "general"));
        return said;
    };
    CHECK(sweep("--replicates 2") == (cpu ? "general" : "special")); // few paths
    nlohmann::json begun = folder.record();
    begun["kernel"] = "special";
    folder.scratch.write("out/sweep.json", begun.dump());
    CHECK(sweep("--replicates 3") == "special");
    std::filesystem::remove_all(folder.scratch / "out");
    CHECK(sweep("--replicates 2 --specialise on") == "special");
    std::filesystem::remove_all(folder.scratch / "out");
    CHECK(sweep("--replicates 2 --specialise off") == "general");
}

TEST_CASE("A sweep is told by all that it reads and by its options", "[sweep]") {
    SceneFolder folder;
    const std::string box = "v -3 -3 5\nv 3 -3 5\nv 3 3 5\nv -3 3 5\nvn 0 0 -1\nf 1//1 3//1 2//1\nf 1//1 4//1 3//1\n";
    folder.scratch.write("floor.obj", "mtllib floor.mtl\nusemtl grey\n" + box);
    folder.scratch.write("floor.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
    const std::string mesh = "<mesh type='obj'><string name='filename' value='floor.obj'/><boolean name='materials' "
                             "value='true'/></mesh></scene>";
    std::string text = scene_text;
    text.replace(text.find("</scene>"), 8, mesh);
    folder.scene = folder.scratch.write("lamp.xml", text);
    const std::string how = "--strategies lighting=emitter lighting=mis --spp 2 --replicates 2 -o out ";
    REQUIRE(folder.sweep(how).exit_code == 0);
    CHECK(folder.sweep(how).exit_code == 0);
    const auto refused = [&](const std::string &what, const std::string &options = "") {
        const Outcome outcome = folder.sweep(how + options);
        INFO(outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK_THAT(outcome.err, Catch::Contains("out/sweep.json: holds another sweep (" + what + " was "));
    };
    refused("seed", "--seed 2");
    refused("reference_spp", "--reference-spp 64");
    refused("options.max-depth", "--max-depth 3");
    refused("width", "--width 12");
    const auto changed = [&](const std::string &file, const std::string &content) {
        const std::string before = read_text(folder.scratch / file);
        folder.scratch.write(file, content);
        refused("scene_hash");
        folder.scratch.write(file, before);
    };
    const std::string obj = read_text(folder.scratch / "floor.obj");
    changed("floor.obj", obj.substr(0, obj.rfind("f "))); // a face removed
    changed("floor.obj", obj + "vn 0 1 0\n");             // normals
    changed("floor.mtl", "newmtl grey\nKd 0.6 0.5 0.5\n");
    std::string tent = text;
    tent.replace(tent.find("</camera>"), 9, "<rfilter type='tent'/></camera>");
    changed("lamp.xml", tent);
    CHECK(folder.sweep(how).exit_code == 0);
}

TEST_CASE("No sample is counted twice: a sweep goes on with its own seed only", "[sweep]") {
    const SceneFolder folder;
    const std::string how = "--strategies lighting=emitter lighting=mis --spp 2 -o out ";
    REQUIRE(folder.sweep(how + "--replicates 2 --seed 2").exit_code == 0);
    CHECK_THAT(folder.sweep(how + "--replicates 4 --seed 0").err, Catch::Contains("(seed was 2, is 0)"));
    REQUIRE(folder.sweep(how + "--replicates 4 --seed 2").exit_code == 0);
    for (const nlohmann::json &strategy : folder.record()["strategies"])
        for (unsigned r = 0; r < 4; r++)
            CHECK(strategy["points"][0]["replicates"][r]["seed"] == 3 + r);
}

TEST_CASE("Two sweeps into one folder: the second ends at once", "[sweep]") {
    const SceneFolder folder;
    const FolderLock lock(folder.scratch.path());
    SceneFolder own;
    std::string text = scene_text;
    text.replace(text.find("0.8 0.8 0.8"), 11, "$a $a $a");
    own.scratch.write("lamp.xml", text);
    for (const std::string how : {"-D a=0.5", "--vary a=0.2,0.8"}) {
        const Outcome outcome = own.sweep(how + " -o " + folder.scratch.path().string());
        INFO(outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK_THAT(outcome.err, Catch::Contains(folder.scratch.path().string() + ": another sweep (process " +
                                                std::to_string(getpid()) + ") writes there"));
        CHECK_FALSE(std::filesystem::exists(folder.scratch / "sweep.json"));
        CHECK_FALSE(std::filesystem::exists(folder.scratch / "a=0.2"));
    }
}

TEST_CASE("A sweep heals what is missing or cut off in its folder", "[sweep]") {
    const SceneFolder folder;
    const std::string how = "--strategies lighting=emitter lighting=mis --spp 2 --replicates 2 -o out ";
    REQUIRE(folder.sweep(how).exit_code == 0);
    const std::vector<std::string> files = {"reference.exr", "reference.png", "equal_time_1.exr", "equal_time_2.png",
                                            "equal_time_1_error.png"};
    const auto record = folder.record();
    const std::string reference = read_text(folder.scratch / "out/reference.exr");
    CHECK(read_exr(folder.scratch / "out/reference.exr").text("opal.scene_hash") == record["scene_hash"]);
    for (const bool cut : {false, true}) {
        for (const std::string &file : files)
            if (cut)
                folder.scratch.write("out/" + file, read_text(folder.scratch / ("out/" + file)).substr(0, 200));
            else
                std::filesystem::remove(folder.scratch / ("out/" + file));
        const Outcome outcome = folder.sweep(how);
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 0);
        CHECK_THAT(outcome.err, Catch::Contains("reference.exr: is missing or was changed; it is rendered again"));
        CHECK(read_text(folder.scratch / "out/reference.exr") == reference);
        for (const std::string &file : files)
            CHECK(is_whole_picture(folder.scratch / ("out/" + file)));
        CHECK(folder.record()["strategies"][0]["points"] == record["strategies"][0]["points"]);
    }
    // A picture of a strategy that is not swept now is left out of the page, in words.
    std::filesystem::remove(folder.scratch / "out/equal_time_1.png");
    REQUIRE(folder.sweep("--strategies lighting=mis --spp 2 --replicates 2 -o out").exit_code == 0);
    const std::string page = read_text(folder.scratch / "out/index.html");
    CHECK(count(page, "the picture is missing") == 1);
    CHECK(count(page, "base64,\"") == 0);
    // Only the strategy that made the reference can make it again.
    std::filesystem::remove(folder.scratch / "out/reference.exr");
    const std::string maker = record["reference"]["made_by"], other = maker == "lighting=mis" ? "emitter" : "mis";
    const Outcome lost = folder.sweep("--strategies lighting=" + other + " --spp 2 --replicates 2 -o out");
    CHECK(lost.exit_code == 1);
    CHECK_THAT(lost.err, Catch::Contains("reference.exr: only strategy " + maker));
}

TEST_CASE("Images that are NaN end a sweep and a verification with the strategy's name", "[sweep]") {
    SceneFolder folder;
    std::string text = scene_text;
    text.replace(text.find("3 3 3"), 5, "1e38 1e38 1e38");
    text.replace(text.find("-0.4 -0.4 4"), 11, "-0.4 0.4 4"); // turned to the camera
    text.replace(text.find("0 0.8 0"), 7, "0 -0.8 0");
    folder.scene = folder.scratch.write("lamp.xml", text);
    const Outcome swept = folder.sweep("--strategies lighting=emitter lighting=mis --spp 64 --replicates 2 -o out");
    CHECK(swept.exit_code == 1);
    CHECK_THAT(swept.err, Catch::Contains("error: lighting=") && Catch::Contains("NaN or infinite"));
    const Outcome verified = run_shell("cd " + folder.scratch.path().string() + " && " OPAL_BINARY " verify " +
                                       folder.scene + " --budget 1s --strategies 'lighting=mis;lighting=emitter'");
    CHECK(verified.exit_code == 1);
    CHECK_THAT(verified.err, Catch::Contains("NaN or infinite, so that nothing can be told"));
}
