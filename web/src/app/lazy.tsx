/** What is fetched only when somebody wants to see it: the first load stays small. */

import type { ComponentType } from "preact";
import { useEffect, useState } from "preact/hooks";
import { t } from "./i18n";

interface Loaded {
  default: ComponentType;
}

export function Lazy({ load }: { load: () => Promise<Loaded> }) {
  const [Found, setFound] = useState<ComponentType | null>(null);
  useEffect(() => {
    let isWanted = true;
    void load().then((module) => isWanted && setFound(() => module.default));
    return () => void (isWanted = false);
  }, []);
  return Found === null ? <p class="quiet">{t("lazy.loading")}</p> : <Found />;
}
