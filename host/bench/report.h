// Reports of `opal bench`, as text and as JSON.
#pragma once

#include "bench/renders.h"
#include "scene/scene.h"

#include <nlohmann/json_fwd.hpp>

namespace opal {

// The subject of the rates: a scene's tree on a device.
struct BenchSubject {
    const SceneDescription &scene;
    const FlatScene &flat;
    const DevicePick &device;
    int lanes = 1;

    std::string scene_text() const;
    std::string device_text() const;
    std::string tree_text() const;
    nlohmann::json json() const;

private:
    double bytes_a_triangle() const;
};

// Rays of one kind.
struct RayFigures {
    std::string kind;
    size_t rays = 0;
    RayTimes times;

    std::string text() const;
    nlohmann::json json() const;
};

// The render itself.
struct RenderFigures {
    unsigned spp = 0;
    PathRates rates;
    PathCounts counts;
    double compile_cold = 0, compile_warm = 0; // seconds

    std::string text() const;
    nlohmann::json json() const;

private:
    double rays_per_second() const;
};

// A variant of the render, compared with it.
struct RaceFigures {
    std::string name;
    Race race;

    std::string text() const;
    nlohmann::json json() const;
};

// The shares of a render's time, each from 0 to 1: a stage that is done twice adds its share. The range is that of the
// rounds. A share whose range reaches 0 is below what can be told.
struct TimeShares {
    Spread traversal, sampling;

    Spread shading() const; // and all else
    std::string text() const;
    nlohmann::json json() const;
};
Spread share_of(const Race &twice); // of the stage that the variant does twice

} // namespace opal
