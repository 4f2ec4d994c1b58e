// Finding devices: a driver that crashes, hangs or has no device loses its own line of the list and no other, and
// the choice of a device is explained.
#include "base/json.h"
#include "base/log.h"
#include "base/process.h"
#include "device/ask_driver.h"
#include "device/kernel_cache.h"
#include "device/opencl.h"
#include "support/device.h"
#include "support/scratch.h"

#include <chrono>
#include <cstdlib>

#include <sys/stat.h>

using namespace opal;
using namespace opal::test;

namespace {

// A driver whose first entry point runs `body` (C), which may call `functions`. Loaders call it before anything else.
Driver make_driver(const ScratchFolder &folder, const std::string &name, const std::string &body,
                   const std::string &functions = "") {
    const std::filesystem::path source = folder.write(
        name + ".c", "#define _GNU_SOURCE\n#include <dlfcn.h>\n#include <stdio.h>\n"
                     "#include <stdlib.h>\n#include <unistd.h>\n" +
                         functions + "void *clGetExtensionFunctionAddress(const char *name) {\n    (void)name;\n    " +
                         body + "\n    return 0;\n}\n");
    const std::string library = folder / ("lib" + name + ".so");
    const Outcome built = run_shell("cc -shared -fPIC " + source.string() + " -o " + library);
    INFO(built.err);
    REQUIRE(built.exit_code == 0);
    return {folder.write("vendors/" + name + ".icd", library + "\n").string(), library};
}

DeviceInfo listed(int index, const std::string &type, const std::string &name, const std::string &problem = "") {
    DeviceInfo info;
    info.index = index;
    info.type = type;
    info.name = name;
    info.platform = "Platform of " + name;
    info.problem = problem;
    return info;
}

// The first installed driver that has a usable device.
Driver good_driver() {
    set_probe_binary(OPAL_BINARY);
    for (const Driver &driver : find_drivers())
        if (const auto devices = probe_drivers({driver}, 60); !devices.empty() && devices[0].problem.empty())
            return {devices[0].library, devices[0].library};
    FAIL("no driver has a device");
    return {};
}

Outcome devices_with(const std::string &environment, const std::string &arguments = "") {
    return run_shell(environment + " " + OPAL_BINARY + " devices " + arguments);
}

// `opal devices` where the loaders know this folder's drivers alone.
Outcome devices_of(const std::filesystem::path &vendors, const std::string &arguments = "") {
    return devices_with("OCL_ICD_FILENAMES= OCL_ICD_VENDORS=" + vendors.string(), arguments);
}

// The drivers that find_drivers finds with these environment variables of the loaders and no others: "NAME -> LIBRARY".
std::vector<std::string> found_with(const std::map<std::string, std::string> &variables) {
    std::map<std::string, std::string> before;
    for (const char *name : {"OCL_ICD_FILENAMES", "OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH"}) {
        if (const char *value = std::getenv(name))
            before[name] = value;
        unsetenv(name);
    }
    for (const auto &[name, value] : variables)
        setenv(name.c_str(), value.c_str(), 1);
    std::vector<std::string> lines;
    for (const Driver &driver : find_drivers())
        lines.push_back(driver.name + " -> " + driver.library);
    for (const auto &[name, value] : variables)
        unsetenv(name.c_str());
    for (const auto &[name, value] : before)
        setenv(name.c_str(), value.c_str(), 1);
    return lines;
}

const std::vector<DeviceInfo> several = {listed(0, "cpu", "llvmpipe (LLVM 15)"), listed(1, "cpu", "Ryzen"),
                                         listed(2, "gpu", "Old GPU", "crashed while it was asked"),
                                         listed(3, "gpu", "Radeon"), listed(4, "gpu", "GeForce")};

} // namespace

TEST_CASE("A driver that crashes or hangs costs its line and no other", "[devices]") {
    set_probe_binary(OPAL_BINARY);
    const ScratchFolder folder;
    const std::vector<Driver> drivers = {make_driver(folder, "crash", "abort();"),
                                         make_driver(folder, "hang", "sleep(60);"), good_driver()};
    const std::vector<DeviceInfo> found = probe_drivers(drivers, 3);
    REQUIRE(found.size() >= 3);
    CHECK(found[0].problem == "crashed while it was asked (Aborted)");
    CHECK(found[0].platform == drivers[0].name);
    CHECK(found[1].problem == "did not answer within 3 s");
    CHECK(found[2].problem == "");
    CHECK(found[2].memory > 0);
}

TEST_CASE("A process that goes on answering is killed at its deadline", "[devices]") {
    using Clock = ChildProcess::Clock;
    ChildProcess process("/bin/sh", {"-c", "for i in $(seq 100); do echo >&3; sleep 0.02; done"}); // more than 2 s
    CHECK(!process.finish(Clock::now() + std::chrono::milliseconds(500)).in_time);
}

TEST_CASE("opal devices survives a crashing driver beside a good one", "[devices]") {
    const ScratchFolder folder;
    make_driver(folder, "a_crash", "abort();");
    folder.write("vendors/good.icd", good_driver().library + "\n");
    const Outcome outcome = devices_of(folder / "vendors");
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out,
               Catch::Contains("a_crash.icd: crashed while it was asked") && Catch::Contains("render takes 1: "));
    const Outcome refused = devices_of(folder / "vendors", "--device 0");
    CHECK(refused.exit_code == 1);
    CHECK_THAT(refused.err, Catch::StartsWith("error: device 0 ") && Catch::Contains("crashed while it was asked"));
}

TEST_CASE("Drivers are found where each loader would look", "[devices]") {
    using Lines = std::vector<std::string>;
    const ScratchFolder folder;
    const auto icd = [&](const std::string &name, const std::string &text) {
        return folder.write("vendors/" + name, text).string();
    };
    const std::string b = icd("b.icd", "libb.so.1\n"),
                      a = icd("a.icd", "# whose it is\n\n \t/opt/a/liba.so \r\nnot this one\n"),
                      empty = icd("empty.icd", "\n# nothing\n"), vendors = (folder / "vendors").string();
    icd("readme.txt", "libc.so\n");
    const Lines all = {a + " -> /opt/a/liba.so", b + " -> libb.so.1", empty + " -> "};
    CHECK(found_with({{"OCL_ICD_VENDORS", vendors}}) == all);
    CHECK(found_with({{"OCL_ICD_VENDORS", vendors + "/"}}).size() == 3);
    CHECK(found_with({{"OPENCL_VENDOR_PATH", vendors}}) == all);
    CHECK(found_with({{"OPENCL_VENDOR_PATH", vendors}, {"OCL_ICD_VENDORS", ""}}) == all);
    CHECK(found_with({{"OCL_ICD_VENDORS", b}}) == Lines{b + " -> libb.so.1"});
    CHECK(found_with({{"OCL_ICD_VENDORS", "b.icd"}, {"OPENCL_VENDOR_PATH", vendors}}) == Lines{b + " -> libb.so.1"});
    CHECK(found_with({{"OCL_ICD_VENDORS", "libc.so.2"}}) == Lines{"libc.so.2 -> libc.so.2"});
    CHECK(found_with({{"OCL_ICD_VENDORS", "/no/such/folder"}}) == Lines{"/no/such/folder -> /no/such/folder"});
    CHECK(found_with({{"OCL_ICD_VENDORS", b}, {"OCL_ICD_FILENAMES", "libx.so::/opt/liby.so"}}) ==
          Lines{"libx.so -> libx.so", "/opt/liby.so -> /opt/liby.so", b + " -> libb.so.1"});
    CHECK(found_with({{"OPENCL_VENDOR_PATH", (folder / "none").string()}}) == Lines{" -> "});
}

TEST_CASE("The loader is told a driver's library in both its variables, and nobody else is", "[devices]") {
    const ScratchFolder folder;
    const std::string told = folder / "told";
    const Driver driver = make_driver(folder, "listener", "FILE *out = fopen(\"" + told + R"(", "w");
    fprintf(out, "%s %s", getenv("OCL_ICD_VENDORS"), getenv("OCL_ICD_FILENAMES")); fclose(out);)");
    set_probe_binary(OPAL_BINARY);
    CHECK(probe_drivers({driver}, 60).at(0).problem == "offers no platform");
    CHECK(read_text(told) == driver.library + " " + driver.library);

    const auto environment = [] { return run_shell("env | grep ^OCL_ICD").out; };
    const std::string before = environment();
    open_device(device().info);
    CHECK(environment() == before);
}

TEST_CASE("A driver with several names is listed once", "[devices]") {
    const Driver good = good_driver();
    const size_t own = probe_drivers({good}, 60).size();
    const ScratchFolder folder;
    std::filesystem::create_symlink(std::filesystem::canonical(good.library), folder / "libother.so");
    folder.write("vendors/a.icd", good.library + "\n");
    folder.write("vendors/b.icd", (folder / "libother.so").string() + "\n");
    const Outcome outcome = devices_with(
        "OCL_ICD_FILENAMES=" + good.library + " OCL_ICD_VENDORS=" + (folder / "vendors").string(), "--json -");
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(nlohmann::json::parse(outcome.out)["devices"].size() == own);
}

TEST_CASE("A driver that gives no device says why", "[devices]") {
    const ScratchFolder folder;
    folder.write("gone.icd", "libgone.so.7\n");
    folder.write("empty.icd", "\n");
    const Outcome outcome = devices_of(folder.path());
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.out,
               Catch::Contains("gone.icd: cannot be loaded (libgone.so.7: cannot open shared object file"));
    CHECK_THAT(outcome.out, Catch::Contains("empty.icd: names no library"));
}

TEST_CASE("opal devices tells what of each device is used and what is not", "[devices]") {
    const auto posing = [](const std::string &pose) {
        return devices_with("LD_PRELOAD=" OPAL_POSING " OPAL_POSE=" + pose,
                            "--device " + std::to_string(device().info.index));
    };
    const Outcome gpu = posing("gpu,no-fp64"), narrow = posing("vectors-of-2");
    CHECK_THAT(gpu.out, Catch::Contains("used: 1 lane, work-groups of 64, buffers of at most ") &&
                            Catch::Contains("--math precise, fast\n"));
    CHECK_THAT(gpu.out, Catch::Contains("not used: local memory; ") &&
                            Catch::Contains("; --math double, as the device lacks cl_khr_fp64\n"));
    CHECK_THAT(narrow.out, Catch::Contains("used: 1 lane, work-groups of 1, ") &&
                               Catch::Contains("vectors of 2 floats, as 4 is the least"));
    if (device().info.fp64)
        CHECK_THAT(narrow.out, Catch::Contains(", double (1 lane)\n"));
}

TEST_CASE("Without any driver the message says what to install", "[devices]") {
    const ScratchFolder folder;
    const Outcome outcome = devices_of(folder.path());
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err, Catch::StartsWith("error: no usable OpenCL device") && Catch::Contains("pocl-opencl-icd"));
}

TEST_CASE("A driver that prints hides no device and is not mixed with results", "[devices]") {
    const Driver good = good_driver();
    const std::string real = std::filesystem::canonical(good.library).string();
    const ScratchFolder folder;
    // It prints at each load and call, without line ends, as much as it likes, and what looks like an answer.
    const std::string noise = R"(printf("opal-device {not JSON\n{\"name\":1}\nloading... "); fflush(stdout);
    for (int i = 0; i < 300000; i++) printf("noise ");)";
    const Driver noisy = make_driver(folder, "noisy", noise + R"(
    void *real = dlopen(")" + real + R"(", RTLD_NOW);
    void *(*find)(const char *) = (void *(*)(const char *))dlsym(real, "clGetExtensionFunctionAddress");
    printf("found "); return find(name);)");
    const std::vector<DeviceInfo> own = probe_drivers({good}, 60), found = probe_drivers({noisy}, 60);
    REQUIRE(found.size() == own.size());
    CHECK(found[0].name == own[0].name);
    CHECK(found[0].problem == "");

    CHECK(nlohmann::json::parse(devices_of(folder / "vendors", "--json -").out)["devices"].size() == own.size());
    const Outcome rendered = run_shell("OCL_ICD_FILENAMES= OCL_ICD_VENDORS=" + (folder / "vendors").string() + " " +
                                       OPAL_BINARY + " render " OPAL_SOURCE_DIR "/scenes/cbox_mis.xml --width 8 " +
                                       "--height 8 --spp 1 --quiet --json - -o " + (folder / "out.exr").string());
    CHECK(rendered.exit_code == 0);
    CHECK(nlohmann::json::accept(rendered.out));
}

TEST_CASE("What a driver prints at the end of the process is not mixed with results", "[devices]") {
    const std::string real = std::filesystem::canonical(good_driver().library).string();
    const ScratchFolder folder;
    const Driver farewell = make_driver(folder, "farewell", R"(static void *real;
    if (!real) { real = dlopen(")" + real + R"(", RTLD_NOW); atexit(say); }
    void *(*find)(const char *) = (void *(*)(const char *))dlsym(real, "clGetExtensionFunctionAddress");
    return find(name);)",
                                        "static void say(void) { printf(\"farewell\"); fflush(stdout); }\n");
    const Outcome rendered = run_shell("OCL_ICD_FILENAMES= OCL_ICD_VENDORS=" + (folder / "vendors").string() + " " +
                                       OPAL_BINARY + " render " OPAL_SOURCE_DIR "/scenes/cbox_mis.xml --width 8 " +
                                       "--height 8 --spp 1 --quiet --json - -o " + (folder / "out.exr").string());
    CHECK(rendered.exit_code == 0);
    CHECK(nlohmann::json::accept(rendered.out));
    CHECK_THAT(rendered.err, Catch::Contains("farewell"));
}

TEST_CASE("opal probe-platform prints what a descriptor 3 of the user's does not get", "[devices]") {
    const ScratchFolder folder;
    const Outcome outcome = run_shell(std::string(OPAL_BINARY) + " probe-platform " + good_driver().library + " 3> " +
                                      (folder / "third").string());
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Catch::StartsWith("{"));
    CHECK(read_text(folder / "third").empty());
}

TEST_CASE("A process that shares the work folder and dies in a first launch costs those kernels alone", "[devices]") {
    const ScratchFolder folder;
    const std::string kernels = folder.write("cache/opal/some.kernels", "kernels").string();
    std::filesystem::permissions(folder / "cache/opal", std::filesystem::perms::owner_all);
    make_driver(folder, "dying",
                "FILE *out = fopen(\"../first_launch-1\", \"w\"); fputs(\"" + kernels +
                    "\", out); fclose(out); abort();"); // processes start in a folder of that one
    const Outcome outcome =
        devices_with("env -u POCL_CACHE_DIR OCL_ICD_FILENAMES= OCL_ICD_VENDORS=" + (folder / "vendors").string() +
                     " XDG_CACHE_HOME=" + (folder / "cache").string());
    CHECK_THAT(outcome.err, Catch::Contains("warning: " + kernels + ": a run ended while it launched"));
    CHECK(!std::filesystem::exists(kernels));
}

TEST_CASE("An .icd file that cannot be read is named, with the reason", "[devices]") {
    const ScratchFolder folder;
    std::filesystem::create_symlink(folder / "nothing", folder / "dangling.icd");
    std::filesystem::create_directory(folder / "folder.icd");
    REQUIRE(mkfifo((folder / "pipe.icd").c_str(), 0600) == 0);
    folder.write("relative.icd", "./libours.so\n");
    const Outcome outcome = devices_of(folder.path());
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.out, Catch::Contains("dangling.icd: cannot read: No such file or directory") &&
                                Catch::Contains("folder.icd: is no regular file") &&
                                Catch::Contains("pipe.icd: is no regular file") &&
                                Catch::Contains("relative.icd: cannot be loaded (./libours.so: "));
    CHECK_THAT(outcome.err, Catch::Contains("dangling.icd: cannot read"));
    CHECK_THAT(
        run_shell("OCL_ICD_FILENAMES= OCL_ICD_VENDORS=" + folder.path().string() + " " OPAL_BINARY " version").out,
        Catch::Contains("dangling.icd: cannot read: No such file or directory") && Catch::Contains("xxHash "));
}

TEST_CASE("A driver that hangs is not asked again within the hour, unless no other has a device", "[devices]") {
    set_probe_binary(OPAL_BINARY);
    const ScratchFolder folder;
    const std::string asked = folder / "asked";
    const Driver hung = make_driver(
        folder, "hung", "FILE *out = fopen(\"" + asked + "\", \"a\"); fputc('x', out); fclose(out); sleep(60);");
    const Driver good = good_driver();
    const auto problem = [&](const std::vector<Driver> &drivers, bool ask_all) {
        return probe_drivers(drivers, 2, ask_all).at(0).problem;
    };
    const auto times = [&] { return read_text(asked).size(); };
    forget_warnings();
    CHECK(problem({hung, good}, false) == "did not answer within 2 s");
    CHECK(times() == 1);
    CHECK_THAT(problem({hung, good}, false), Catch::Contains("is not asked again"));
    CHECK(times() == 1);
    REQUIRE(warnings().size() == 2);
    CHECK_THAT(warnings()[1], Catch::StartsWith(hung.name + ": "));
    CHECK(problem({hung}, false) == "did not answer within 2 s");
    CHECK(problem({hung, good}, true) == "did not answer within 2 s");
    CHECK(times() == 3);

    std::filesystem::path note; // of the driver's silence, from a clock that was put back since
    for (const auto &entry : std::filesystem::directory_iterator(cache_folder().path))
        if (entry.path().extension() == silent_extension &&
            (note.empty() || entry.last_write_time() > std::filesystem::last_write_time(note)))
            note = entry.path();
    REQUIRE(!note.empty());
    std::filesystem::last_write_time(note, std::filesystem::file_time_type::clock::now() + std::chrono::hours(2));
    CHECK(problem({hung, good}, false) == "did not answer within 2 s");
    CHECK(times() == 4);
    forget_warnings();
}

TEST_CASE("A process that asks a driver ends with its parent", "[devices]") {
    const ScratchFolder folder;
    const std::string asker = folder / "asker";
    make_driver(folder, "slow",
                "FILE *out = fopen(\"" + asker + "\", \"w\"); fprintf(out, \"%d\", getpid()); fclose(out); sleep(60);");
    const Outcome outcome = run_shell("OCL_ICD_FILENAMES= OCL_ICD_VENDORS=" + (folder / "vendors").string() + " " +
                                      OPAL_BINARY + " devices & opal=$!; for i in $(seq 600); do [ -s " + asker +
                                      " ] && break; sleep 0.1; done; kill -9 $opal; wait $opal; " +
                                      "for i in $(seq 100); do grep -q '^State:.[^ZX]' /proc/$(cat " + asker +
                                      ")/status || exit 7; sleep 0.1; done"); // a zombie has ended
    CHECK(outcome.exit_code == 7);
}

TEST_CASE("The default is the first usable GPU, else a CPU, else a software rasteriser", "[devices]") {
    const auto pick = [](std::vector<DeviceInfo> devices) { return pick_device("", devices); };
    CHECK(pick(several).info.index == 3);
    CHECK(pick({several[0], several[1], several[2]}).info.index == 1);
    CHECK(pick({several[0], several[1]}).reason == "the first CPU device, as there is no GPU");
    CHECK(pick({several[0]}).reason == "only a software rasteriser was found");
    CHECK_THROWS_WITH(pick({several[2]}),
                      Catch::Contains("no usable OpenCL device; found: 2 (Platform of Old GPU: crashed"));
}

TEST_CASE("A device is chosen by index, type or part of its name", "[devices]") {
    CHECK(pick_device("4", several).info.name == "GeForce");
    CHECK(pick_device("gpu", several).info.name == "Radeon");
    CHECK(pick_device("CPU", several).info.index == 0);
    CHECK(pick_device("ryz", several).info.name == "Ryzen");
    CHECK_THROWS_WITH(pick_device("2", several),
                      Catch::StartsWith("device 2 (Platform of Old GPU) cannot be used: it crashed"));
    CHECK_THROWS_WITH(pick_device("9", several),
                      Catch::StartsWith("no OpenCL device \"9\"; available: 0 (cpu, llvmpipe"));
    CHECK_THROWS_WITH(pick_device("Voodoo", several), Catch::Contains("4 (gpu, GeForce)"));
}

TEST_CASE("The device that is opened is the one that was listed", "[devices]") {
    CHECK(device().handles->device.getInfo<CL_DEVICE_NAME>().find(device().info.name) != std::string::npos);
    CHECK(device().handles->queue.getInfo<CL_QUEUE_PROPERTIES>() == CL_QUEUE_PROFILING_ENABLE);
    const std::string wanted = std::to_string(device().info.index);
    CHECK_THAT(run_shell(std::string(OPAL_BINARY) + " devices --json - --device " + wanted).out,
               Catch::Contains(device().info.driver));
}
