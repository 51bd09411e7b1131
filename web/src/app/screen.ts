/** What kind of screen the page is on. */

import { signal } from "@preact/signals";

/** A phone upright or lying down: two panels beside the view would leave nothing of it. */
const kPhone = "(max-width: 640px), (max-height: 480px) and (max-width: 960px)";

export const isPhone = signal(false);

export function followScreen(): void {
  const query = matchMedia(kPhone);
  const follow = () => (isPhone.value = query.matches);
  query.addEventListener("change", follow);
  follow();
}
