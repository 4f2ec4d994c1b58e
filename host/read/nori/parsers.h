// One parse function for each kind of object, each behind a table: XML type -> function. All throw Error at
// file:line:col, and resolve every default.
#pragma once

#include "read/nori/properties.h"

namespace opal {

Bsdf parse_bsdf(const XmlNode &node, const ParseContext &context);
Bsdf default_bsdf(); // of a mesh without one: diffuse, albedo 0.5

Color parse_area_emitter(const XmlNode &node, const ParseContext &context);       // child of a mesh: its radiance
PointLight parse_scene_emitter(const XmlNode &node, const ParseContext &context); // child of the scene

Mesh parse_mesh(const XmlNode &node, const ParseContext &context);

Filter parse_filter(const XmlNode &node, const ParseContext &context);
Camera parse_camera(const XmlNode &node, const ParseContext &context);

// Sets the integrator's type, strategy, and what else it carries.
void parse_integrator(const XmlNode &node, const ParseContext &context, SceneDescription &scene);
// Sets samples per pixel and the sampler axis.
void parse_sampler(const XmlNode &node, const ParseContext &context, SceneDescription &scene);

// A <scene>, also where it is the child of a <test>.
SceneDescription parse_scene(const XmlNode &node, const ParseContext &context);

} // namespace opal
