#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "product/ids.h"
#include "studio/event_bus.h"
#include "studio/json.h"
#include "studio/live_scene.h"
#include "studio/scene_observer.h"

namespace hvas::studio {

/** Remarks that are pinned to parts of the open product. They are saved with the work, and the
 record of a session has them. Any thread may call any function. */
class WorkbenchNotes final : public SceneObserver {
 public:
  static constexpr std::size_t kMaxNotes = 200;  ///< Notes on one product: a choice.

  WorkbenchNotes(const LiveScene* live, const EventBus* events) : live_(live), events_(events) {}

  /** A note that is to be made. */
  struct Remark {
    std::string by;  ///< Who has written it.
    std::string text;
    product::OccurrenceId occurrence;
    Vec3 p_B{Vec3::Zero()};  ///< Place of the pin, in the part's frame.
  };

  /** Pins a note to a part. Reports by the event "notes". @returns its id. Errors: kNotFound
   without a scene or such a part; kInvalid for a text without a visible character; kOutOfResource
   beyond kMaxNotes. */
  [[nodiscard]] Result<std::string> Add(const Remark& remark);

  /** Takes a note away. Reports by the event "notes". Errors: kNotFound for an unknown id. */
  [[nodiscard]] Result<void> Remove(const std::string& id);

  /** Makes the event "notes" of docs/protocol.md. */
  [[nodiscard]] Json MakeEvent() const;

  /** The notes, for saved work. */
  [[nodiscard]] std::vector<Json> List() const;

  /** Takes over the notes of saved work for the open product; those that are damaged are left out.
   Reports by the event "notes". */
  void Restore(const std::vector<Json>& notes);

 private:
  void ConfigureRun(const OpenScene& scene, LiveOptions* live) override;
  void OnRunBegun() override;

  const LiveScene* const live_;
  const EventBus* const events_;

  mutable std::mutex mutex_;  ///< Protects what follows.
  std::vector<Json> notes_;   ///< Items of the event "notes".
  std::string digest_;        ///< OpenScene::digest of the product that they are for.
  std::uint32_t last_id_{0};
};

/** Text of a user in one line: without control characters, and without blanks at its ends. */
[[nodiscard]] std::string MakeOneLine(std::string_view text);

}  // namespace hvas::studio
