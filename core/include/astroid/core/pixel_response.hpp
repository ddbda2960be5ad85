// Sensitivity that varies within a pixel.
#pragma once

#include <complex>
#include <span>
#include <string>
#include <vector>

namespace astroid {

/// Sensitivity within a pixel: constant in each of cells x cells squares, row by row, mean 1.
///
/// What a pixel is as a whole is left to flat field and PRNU, so uniform light gives the same electrons with and
/// without it; a star gives more or fewer with its place in the pixel.
struct PixelResponse {
  int cells = 1;
  std::vector<double> sensitivity = {1.0};

  [[nodiscard]] bool is_uniform() const;
  [[nodiscard]] double at(int column, int row) const {
    return sensitivity[static_cast<std::size_t>(row * cells + column)];
  }
  /// Largest difference of a cell from the mean.
  [[nodiscard]] double depth() const;

  friend bool operator==(const PixelResponse&, const PixelResponse&) = default;
};

/// (F103) Means over the cells, divided by the mean over the pixel, of a response that falls from 1 to 1 - depth:
/// @param cells  per axis, at least 1.  @param depth  0 … 1: what is missing at the edge.
///
/// edge: 1 - depth within `width` px of the pixel's border, 1 inside, as a border of insensitive electrodes or channel
/// stops. @param width  px, 0 … 0.5. @source MarcosArenal2014 (FlatfieldIntraWidth; depth 0.05 there)
PixelResponse edge_response(int cells, double depth, double width);
/// c(x) c(y), c(x) = 1 - depth (1 - cos 2 pi x)/2: smooth, 1 in the centre, 1 - depth in the middle of an edge.
PixelResponse cosine_response(int cells, double depth);
/// c(x) c(y), c(x) = e^(-x²/2 s²) with c(1/2) = 1 - depth.
PixelResponse gaussian_response(int cells, double depth);

/// Fourier transform of the response over its pixel, on a grid of frequencies in cycles/px, one row for each ky: 1 at
/// (0, 0), sinc(kx) sinc(ky) if uniform.
void sample_response(const PixelResponse& response, std::span<const double> kx, std::span<const double> ky,
                     std::span<std::complex<double>> values);

}  // namespace astroid
