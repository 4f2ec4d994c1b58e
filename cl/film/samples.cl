// samples: where a pass leaves its samples until they are added to the film. Channel c of a pixel's sample is the float
// SAMPLE_WORD(pixel, sample, pass_samples) + SAMPLE_CHANNEL(c, pass_samples).
//   uint load_colors(samples, pixel, sample, pass_samples, colors)
//       reads the colours of each lane's pixel, of samples from `sample` on, into colors[0], colors[1] ..., LANES at
//       the most. Returns how many.
//   void fetch_next(samples, pixel, s, pass_samples)
//       prefetches what the work-item reads that comes after the one of `pixel`, its first; a part of it each s
#if LANES == 1
#include "film/one_lane/samples.cl"
#else
#include "film/many_lanes/samples.cl"
#endif
