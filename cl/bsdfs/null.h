// The parameters of BSDF null: a surface that changes no light (bsdfs/null.cl).
#ifndef OPAL_BSDF_NULL_H
#define OPAL_BSDF_NULL_H

#include "shared/parameters.h"

#define OPAL_BSDF_null(PARAMETER)

#endif
