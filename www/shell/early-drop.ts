/** Keeps what was dropped before the tool was loaded: the browser releases it after the event. */

/** What the tool reads of a `drop` event. */
export interface Drop {
  readonly type: string;
  readonly dataTransfer: {
    readonly files: ArrayLike<File>;
    readonly items: ArrayLike<Pick<DataTransferItem, 'kind' | 'getAsFile' | 'webkitGetAsEntry'>>;
  } | null;
}

/** The drop, for later. Call this in the event handler. */
export function keptDrop({ type, dataTransfer }: DragEvent): Drop {
  const items = Array.from(dataTransfer?.items ?? [], (item) => {
    const { kind } = item;
    const [entry, file] = [item.webkitGetAsEntry(), item.getAsFile()];
    return { kind, webkitGetAsEntry: () => entry, getAsFile: () => file };
  });
  return { type, dataTransfer: { files: [...(dataTransfer?.files ?? [])], items } };
}
