// The renderer: adds passes of samples to a film on the device. Each pass is cut into launches that are short enough to
// be interrupted. A sample depends on its pixel, index and seed alone, not on passes and launches.
#pragma once

#include "device/context.h"
#include "device/sources.h"
#include "film/film.h"
#include "flatten/flat_scene.h"

#include <functional>
#include <memory>

namespace cl {
class Kernel;
class Program;
} // namespace cl

namespace opal {

struct RenderOptions {
    BuildOptions build;
    const Sources *sources = &Sources::embedded();
    double launch_seconds = 0.1;   // aim for a launch; a screen's watchdog may kill one of more than about 2 s
    unsigned max_pass_samples = 0; // of a pixel; 0: as many as memory and launch_seconds allow
};

// The kernels that add a pass to the film (cl/kernels/film.cl), compiled once for all scenes: drivers keep programs by
// their text. sampler: the one that gathering for a wide filter draws by; -1: the settings say. seconds: what it took.
cl::Program build_film_program(const Device &device, const BuildOptions &options, const Sources &sources,
                               int sampler = -1, double *seconds = nullptr);

class Renderer {
public:
    // Compiles the program and uploads the scene. Throws Error if the program does not build or memory does not
    // suffice. A scene that is moved in is not copied by devices that share the host's memory.
    Renderer(const Device &device, FlatScene scene, const RenderOptions &options);
    ~Renderer();

    // A callback after each launch, with the samples of each pixel so far (a fraction within a pass) and the kernel
    // seconds; it returns false to stop.
    using OnLaunch = std::function<bool(double samples_done, double kernel_seconds)>;

    // Adds samples [next_sample(), end) of each pixel to the film. Returns false if it was stopped: then the finished
    // launches of the last pass are added, too, so that pixels differ in their sample counts and may have none after
    // the first pass. Pixels with more samples lie evenly over the image. Where paths may be endless
    // (FEATURE_endless_paths), they go on from launch to launch, with a callback after each.
    bool render(unsigned end, const OnLaunch &on_launch = {});

    // The samples of a pixel in the renders from the next restart on: the strata of --sampler stratified. At first the
    // scene's spp.
    void plan_samples(unsigned spp) { settings_.spp = spp; }

    // Frees the film and takes the memory of the film of `other`, whose image has the same size and filter. From then
    // on each of both must restart before it renders, and its film be read before the other restarts.
    void share_film(const Renderer &other);

    // Empties the film. The next sample has the index `first_sample` and the random numbers of `seed`.
    void restart(unsigned seed, unsigned first_sample = 0);

    Film film() const;
    // The same film. Its memory on the device is freed as it is read: the renderer renders no more.
    Film take_film();
    bool has_endless_paths() const { return endless_paths_; } // perhaps: a launch may leave paths for the next one
    unsigned next_sample() const { return next_sample_; }
    double kernel_seconds() const { return kernel_seconds_; } // of all launches since the last restart
    double compile_seconds() const { return compile_seconds_; }

private:
    struct OnDevice; // buffers and kernels
    struct FilmBand;
    // How a pass is cut into launches and work-items: a work-item for each chunk of the samples of each tile. It is the
    // same for all passes, because drivers compile a kernel anew for each shape.
    struct LaunchShape {
        unsigned tile_width, tile_height; // pixels
        unsigned items_a_launch, local_size;
        unsigned tiles, chunks; // of the image, and of a tile's samples
    };
    LaunchShape launch_shape() const;
    void set_film_arguments();
    double warm_up();
    bool render_pass(unsigned samples, const OnLaunch &on_launch);
    void make_room_for_unfinished();
    void set_round_arguments(unsigned most_rounds, bool again);
    bool render_items(const std::function<bool()> &goes_on);
    void set_pass_arguments(cl::Kernel &kernel, unsigned first_argument, unsigned chunk_samples, unsigned pass_samples);
    double launch(const cl::Kernel &kernel, unsigned items);
    unsigned next_pass_samples(unsigned left) const;
    bool by_strips() const;
    void gather(unsigned samples);
    template <class Visit> void visit_shown(const FilmBand &band, Visit visit) const;
    void read_band(const FilmBand &band, Film &film) const;
    template <class AfterBand> Film read_film(AfterBand after_band) const;

    const Device device_; // a copy of handles to the same device
    Settings settings_;
    Crop crop_;
    RenderOptions options_;
    LaunchShape shape_{};
    size_t pixels_ = 0; // of the device's film
    bool wide_filter_ = false;
    bool endless_paths_ = false;
    bool empty_ = true; // no pass was added to the film yet
    std::unique_ptr<OnDevice> on_device_;
    unsigned next_sample_ = 0;
    unsigned buffer_spp_ = 0; // samples of each pixel that there is room for
    double kernel_seconds_ = 0, compile_seconds_ = 0;
    double most_rounds_ = 1024;   // where paths may be endless: of a launch that starts paths
    double seconds_a_sample_ = 0; // kernel time of one sample of each pixel in the last pass; 0: no pass yet
};

} // namespace opal
