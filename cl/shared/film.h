// The film in the device's memory: the samples that a pass leaves, and the sums that they are added to.
#ifndef OPAL_FILM_H
#define OPAL_FILM_H

#define OPAL_SAMPLE_FLOATS 3            // of a sample: r, g, b
#define OPAL_SAMPLE_EMPTY 0x7fc0de1au   // bits of a sample's first float where it was not rendered
#define OPAL_INVALID_RECORDS 8          // so many samples that are not finite are recorded by pixel and index

// Strips of the film, a work-item each, where kernels of several lanes gather for wide filters that reach no farther.
#define OPAL_STRIP_REACH 4   // pixels, along each axis
#define OPAL_STRIP_VECTORS 4 // pixels across, times the lanes
#define OPAL_STRIP_ROWS 8

// The film's planes, one float a pixel each. A sum is a pair of floats: a plane, and the low part that it has lost to
// rounding. The film is cut into bands of consecutive pixels, each with memory of its own, because devices bound the
// size of a buffer: plane by plane, and of wide filters the weighted sums apart.
enum {
    FILM_SUM = 0,           // of r, g, b
    FILM_SUM_LOW = 3,
    FILM_SQUARES = 6,       // of r^2, g^2, b^2, luminance^2
    FILM_SQUARES_LOW = 10,
    FILM_PLANES = 14
};
enum {
    FILM_WEIGHTED = 0,      // wide filters: of w r, w g, w b, w
    FILM_WEIGHTED_LOW = 4,
    FILM_WEIGHTED_PLANES = 8
};

#endif
