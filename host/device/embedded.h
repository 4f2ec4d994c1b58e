// The files below cl/ as scripts/embed_cl.py put them into the binary: "kernels/render.cl" -> text.
#pragma once

#include <map>
#include <string>

namespace opal {

const std::map<std::string, std::string> &embedded_files();

} // namespace opal
