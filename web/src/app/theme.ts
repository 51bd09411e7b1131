/** Dark, light, or what the system has; `data-theme` of the page is what the style goes by. */

import { effect } from "@preact/signals";
import { view } from "./app_state";

export function followTheme(): void {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const apply = () => {
    const choice = view.theme.value;
    const isDark = choice === "system" ? system.matches : choice === "dark";
    document.documentElement.dataset["theme"] = isDark ? "dark" : "light";
    view.isDark.value = isDark;
  };
  effect(apply);
  system.addEventListener("change", apply);
}
