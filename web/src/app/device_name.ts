import { kPointer } from "../model/hands";
import type { HandSetup } from "../protocol/messages";
import { t } from "./i18n";

export function deviceName({ device }: HandSetup): string {
  return device.index === kPointer ? t("devices.mouse") : device.name;
}
