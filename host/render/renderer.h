// Renders a flat scene on a device: passes of samples into the film, cut into launches that are short enough to be
// interrupted. What is rendered depends on pixel, sample index and seed alone, not on the cuts.
#pragma once

#include "device/context.h"
#include "device/sources.h"
#include "film/film.h"
#include "flatten/flat_scene.h"

#include <functional>
#include <memory>

namespace cl {
class Kernel;
}

namespace opal {

struct RenderOptions {
    BuildOptions build;
    const Sources *sources = &Sources::embedded();
    double launch_seconds = 0.1;   // aimed at; a screen's watchdog may kill what takes longer than about 2 s
    unsigned max_pass_samples = 0; // 0: what memory and launch_seconds allow; tests cut passes with it
};

class Renderer {
public:
    // Compiles the program and uploads the scene. Error: what does not build or fit.
    Renderer(const Device &device, const FlatScene &scene, const RenderOptions &options);
    ~Renderer();

    // Asked after each launch with the samples a pixel (a fraction within a pass) and the kernel seconds so far; false
    // stops.
    using Continue = std::function<bool(double samples_done, double kernel_seconds)>;

    // Adds samples [next_sample(), end) of each pixel to the film; true when all were added. When stopped, what the
    // last pass had finished is added too: pixels then differ in their counts, in the first pass some have no sample.
    // Those that have more lie evenly over the image.
    bool render(unsigned end, const Continue &go_on = {});

    // Empties the film; the next sample is `first_sample` of `seed`.
    void restart(unsigned seed, unsigned first_sample = 0);

    Film film() const;
    unsigned next_sample() const { return next_; }
    double kernel_seconds() const { return kernel_seconds_; } // of all launches since the last restart
    double compile_seconds() const { return compile_seconds_; }

private:
    struct OnDevice; // buffers and kernels
    struct Shape {   // of the launches; constant, because drivers compile a kernel anew for each
        unsigned tile_width, tile_height, items_a_launch, local_size;
        unsigned tiles, chunks; // work-items a pass: each tile's samples are cut into chunks
    };
    Shape shape_of_launches() const;
    double warm_up();
    bool render_pass(unsigned samples, const Continue &go_on);
    void set_pass_arguments(cl::Kernel &kernel, unsigned place, unsigned chunk_samples, unsigned pass_samples);
    double launch(const cl::Kernel &kernel, unsigned items);
    unsigned next_pass_samples(unsigned left) const;

    const Device device_; // handles: a copy shares the device
    Settings settings_;
    RenderOptions options_;
    Shape shape_{};
    size_t pixels_ = 0;
    bool wide_filter_ = false;
    std::unique_ptr<OnDevice> on_device_;
    unsigned next_ = 0, slot_samples_ = 0;
    double kernel_seconds_ = 0, compile_seconds_ = 0;
    double seconds_a_sample_ = 0; // of one sample of each pixel, by the last pass
};

} // namespace opal
