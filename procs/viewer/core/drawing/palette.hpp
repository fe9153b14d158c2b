// SPDX-License-Identifier: BSD-3-Clause
// Colours of the pictures. Paths and states: Okabe & Ito (2008), distinct with any colour vision.
#pragma once

#include <opencv2/core.hpp>

namespace waymark::viewer {

using Colour = cv::Vec3b;  ///< blue, green, red

/// From red, green, blue; OpenCV's order is blue, green, red.
inline cv::Scalar rgb(int red, int green, int blue) {
  return {static_cast<double>(blue), static_cast<double>(green), static_cast<double>(red), 0.0};
}

inline Colour to_colour(const cv::Scalar& scalar) {
  return {static_cast<uchar>(scalar[0]), static_cast<uchar>(scalar[1]),
          static_cast<uchar>(scalar[2])};
}

namespace palette {

inline const cv::Scalar kPage = rgb(255, 255, 255);
inline const cv::Scalar kInk = rgb(38, 44, 52);
inline const cv::Scalar kFaintInk = rgb(128, 136, 146);
inline const cv::Scalar kHairline = rgb(205, 209, 214);
inline const cv::Scalar kUnknown = rgb(231, 233, 236);
inline const cv::Scalar kFree = rgb(255, 255, 255);
inline const cv::Scalar kOccupied = rgb(70, 77, 87);

inline const cv::Scalar kEstimated = rgb(0, 114, 178);  // blue
inline const cv::Scalar kTrue = rgb(0, 158, 115);       // bluish green
inline const cv::Scalar kOdometry = rgb(230, 159, 0);   // orange
inline const cv::Scalar kEllipse = rgb(0, 114, 178);
inline const cv::Scalar kParticle = rgb(86, 180, 233);  // sky blue
inline const cv::Scalar kMarker = rgb(196, 78, 20);     // vermillion, darker for white text
inline const cv::Scalar kMoved = rgb(126, 47, 142);     // a marker that is not where it was
inline const cv::Scalar kFinal = rgb(38, 44, 52);  // the trajectory as known at the end of the run

inline const cv::Scalar kInitialising = rgb(190, 222, 245);
inline const cv::Scalar kDegenerate = rgb(240, 228, 66);  // yellow
inline const cv::Scalar kLost = rgb(204, 121, 167);       // reddish purple
inline const cv::Scalar kNoHealth = rgb(214, 214, 214);

/// Colour of text: white on a dark background, kInk on a bright one.
cv::Scalar text_on(const cv::Scalar& background);

}  // namespace palette

/// A saturated colour for a marker id; consecutive ids have distant hues.
cv::Scalar colour_of_id(int id);

/// Mixture of two colours: `from` at fraction 0, `to` at 1.
cv::Scalar blend(const cv::Scalar& from, const cv::Scalar& to, double fraction);

}  // namespace waymark::viewer
