// Parsers of Nori's objects, one a kind; the XML's `type` picks a row of the kind's table. All fill in the defaults.
// Mistakes go to the context; an object that cannot be made throws NoObject.
#pragma once

#include "read/nori/properties.h"

namespace opal {

struct LoadOptions;
ParseContext context_for(const std::filesystem::path &file, const LoadOptions &options, Mistakes &mistakes);

Bsdf parse_bsdf(const XmlNode &node, const ParseContext &context);

// Sets the parameter that a <texture> names by its attribute `name`, or without one the first colour. material: the
// object that the bsdf was made of
void apply_texture(const XmlNode &node, const ParseContext &context, const XmlNode &material, Bsdf &bsdf);
// Sets the first colour of a bsdf, if it has one, to the picture that a property of type string names.
void apply_picture(Properties &properties, Bsdf &bsdf);

// The file that a property names: beside the XML file, else in the current folder. Backslashes separate folders, too.
// A missing one is a mistake; if lenient, a warning that says what is done `instead`. Then throws NoObject.
std::filesystem::path find_file(const Properties &properties, const std::string &property, std::string name,
                                const std::string &instead);

void parse_area_emitter(const XmlNode &node, const ParseContext &context, Mesh &mesh); // a child of the mesh
Light parse_scene_emitter(const XmlNode &node, const ParseContext &context);           // a child of the scene

// Error at the property if its value, in single precision as the device sees it, is none that the parameter may have.
void check_range(const Properties &properties, const Parameter &parameter, double value);

// A mesh; several, one a material, where it asks for the materials of its OBJ file.
std::vector<Mesh> parse_meshes(const XmlNode &node, const ParseContext &context);

Filter parse_filter(const XmlNode &node, const ParseContext &context);
Camera parse_camera(const XmlNode &node, const ParseContext &context);

// Sets the integrator's type, the strategy, and the integrator's own parameters.
void parse_integrator(const XmlNode &node, const ParseContext &context, SceneDescription &scene);
// Sets samples per pixel and the sampler axis.
void parse_sampler(const XmlNode &node, const ParseContext &context, SceneDescription &scene);

// A <scene>: the root of a file, or a child of a <test>.
SceneDescription parse_scene(const XmlNode &node, const ParseContext &context);

} // namespace opal
