// The scene's tables in the device's memory, each said once: Scene and the kernels' parameters (cl/scene.cl), the
// host's vectors, their upload and `opal inspect` are made of this list.
#ifndef OPAL_SCENE_TABLES_H
#define OPAL_SCENE_TABLES_H

#include "bsdfs/list.h"
#include "cameras/list.h"
#include "emitters/list.h"
#include "shapes/list.h"
#include "shared/types.h"
#include "textures/list.h"

// TABLE(record, name, shown): an array of records; `shown` is what messages call it. The order is that of the
// parameters.
#define OPAL_TABLES(TABLE) \
    TABLE(CameraRecord, cameras, "cameras")                     /* one */ \
    TABLE(BvhNode, nodes, "nodes")                              /* none: no tree */ \
    OPAL_SHAPE_TABLES(TABLE) \
    TABLE(float, normals, "normals")                            /* 3 each */ \
    TABLE(float, face_vertices, "listed vertices")              /* of the face list: 3 each, distinct */ \
    TABLE(FaceRecord, faces, "listed faces")                    /* the face list, beside the tree */ \
    TABLE(MeshRecord, meshes, "meshes") \
    TABLE(uint, bsdfs, "words of bsdfs")                        /* records of bsdfs/list.h; equal ones are shared */ \
    TABLE(uint, textures, "words of textures")                  /* records of textures/list.h */ \
    TABLE(uint, texels, "words of texels")                      /* bytes and floats of bitmaps */ \
    TABLE(float, attributes, "numbers of mesh attributes")      /* of the textures that name them */ \
    TABLE(EmitterRecord, emitters, "emitters") \
    TABLE(LightTriangle, light_triangles, "light triangles") \
    TABLE(EnvironmentTexel, environment_texels, "texels of the environment")

#endif
