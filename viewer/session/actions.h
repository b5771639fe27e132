#pragma once

namespace adamas::viewer {

/// What a user can do to a session, by a key or a button.
enum class Action {
  kViewFront,
  kViewRight,
  kViewTop,
  kViewIsometric,
  kProjection,
  kShowAll,
  kCameraMode,
  kEdges,
  kField,
  kColourBar,
  kColourMap,
  kAxes,
  kBox,
  kShading,
  kCut,
  kCulledFrom,
  kHidden,
  kPanels,
  kHelp,
  kBookmark,
  kNextBookmark,
  kRecord,
  kPlay,
  kPlayCamera,
  kPreviousStep,
  kNextStep,
  kFirstStep,
  kLastStep,
  kTime,
  kExportFilm,
  kExportFrames,
  kScreenshot,
  kQuit,
};

}  // namespace adamas::viewer
